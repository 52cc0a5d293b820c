#include "boards.hpp"

#include <cmath>

namespace pong
{

namespace
{

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::Vector2d;
using Eigen::Vector3d;

Matrix3d turn(const Vector3d &vector)
{
	const double angle = vector.norm();
	return angle > 0 ? Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix() : Matrix3d::Identity().eval();
}

Vector3d normal_vector(std::mt19937_64 &random, double sigma)
{
	std::normal_distribution<double> normal(0, 1);
	const double x = normal(random), y = normal(random), z = normal(random);
	return sigma * Vector3d(x, y, z);
}

Matrix4d pose(const Matrix3d &R, const Vector3d &t)
{
	Matrix4d matrix = Matrix4d::Identity();
	matrix.topLeftCorner<3, 3>() = R;
	matrix.topRightCorner<3, 1>() = t;
	return matrix;
}

// Upright on the table, facing the cameras, in the height at which they look: board x to the cameras' right, y down.
Matrix4d plane_pose(double z)
{
	return pose(Vector3d(-1, -1, 1).asDiagonal(), {0, 0.5 - std::tan(13 * M_PI / 180) * (z + 0.4), z});
}

Vector3d corner_place(const BoardShape &shape, int column, int row)
{
	return {(column - (shape.columns - 1) / 2.0) * shape.square, (row - (shape.rows - 1) / 2.0) * shape.square, 0};
}

bool wholly_seen(const TrueRig &rig, const BoardShape &shape, const Matrix4d &board)
{
	Vector2d pixel;
	for (const TrueCamera &camera : rig.camera)
		for (int row = 0; row < shape.rows; row += shape.rows - 1)
			for (int column = 0; column < shape.columns; column += shape.columns - 1)
				if (!camera.see((board * corner_place(shape, column, row).homogeneous()).head<3>(),
						pixel))
					return false;
	return true;
}

// A board held at will, wholly in both pictures: anywhere in the left one, tilted by up to 0.6 rad about each axis.
Matrix4d held_pose(const TrueRig &rig, const Session &session, std::mt19937_64 &random)
{
	const TrueCamera &left = rig.camera[PONG_LEFT];
	std::uniform_real_distribution<double> depth(0.6, session.farthest), angle(-0.6, 0.6), part(0, 1);
	for (;;) {
		const double z = depth(random), a = angle(random), b = angle(random), c = angle(random) / 2;
		const double x = (part(random) * true_width - left.cu) / left.fu * z;
		const double y = (part(random) * true_height - left.cv) / left.fv * z;
		const Matrix3d back = left.R.transpose();
		const Matrix4d board = pose(back * turn({a, b, c}), left.centre + back * Vector3d(x, y, z));
		if (wholly_seen(rig, session.shape, board))
			return board;
	}
}

void see_board(const TrueRig &rig, const Session &session, Recording &recording, std::mt19937_64 &random)
{
	std::normal_distribution<double> normal(0, session.noise);
	const BoardShape &shape = session.shape;
	const Matrix4d &board = recording.poses.back();
	for (const pong_side side : {PONG_LEFT, PONG_RIGHT})
		for (int point = 0; point < shape.columns * shape.rows; point++) {
			const Vector3d place = corner_place(shape, point % shape.columns, point / shape.columns);
			Vector2d pixel;
			if (!rig.camera[side].see((board * place.homogeneous()).head<3>(), pixel))
				continue;
			const double du = normal(random), dv = normal(random);
			recording.corners.push_back({static_cast<int>(recording.poses.size()) - 1,
						     side,
						     point,
						     {place.x(), place.y(), place.z()},
						     {pixel.x() + du, pixel.y() + dv},
						     1});
		}
}

pong_view placed_view(const Matrix4d &nominal, const Session &session)
{
	pong_view view = {};
	view.placed = 1;
	for (int i = 0; i < 3; i++)
		for (int j = 0; j < 4; j++)
			view.pose[i][j] = nominal(i, j);
	view.sigma_position = session.placement;
	view.sigma_angle = session.tilt;
	return view;
}

} // namespace

bool TrueCamera::see(const Vector3d &point, Vector2d &pixel) const
{
	const Vector3d q = R * (point - centre);
	if (q.z() < 0.05)
		return false;
	const double x = q.x() / q.z(), y = q.y() / q.z(), r2 = x * x + y * y, radial = 1 + k1 * r2 + k2 * r2 * r2;
	pixel = {fu * (x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)) + cu,
		 fv * (y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y) + cv};
	return pixel.x() > 4 && pixel.y() > 4 && pixel.x() < true_width - 5 && pixel.y() < true_height - 5;
}

TrueRig true_rig(double k1)
{
	const double f = 8 / 0.0074, pitch = 13 * M_PI / 180;
	Matrix3d R;
	R << -1, 0, 0, 0, -std::cos(pitch), -std::sin(pitch), 0, -std::sin(pitch), std::cos(pitch);
	TrueRig rig;
	for (const int side : {0, 1}) {
		const double s = side ? 1 : -1;
		rig.camera[side] = {f * (1 + 0.002 * s),
				    f * (1 + 0.002 * s),
				    319.5 + 6 * s,
				    235.5,
				    k1,
				    0,
				    k1 == 0 ? 0 : 0.0004 * s,
				    k1 == 0 ? 0 : -0.0003,
				    turn({0.004 * s, 0.007, 0.003 * s}) * R,
				    {-s * 0.09, 0.5, -0.4}};
	}
	return rig;
}

Recording record(const TrueRig &rig, const Session &session, std::mt19937_64 &random)
{
	Recording recording;
	for (const double z : {0.2, 0.4, 0.6, 0.8}) {
		if (!session.planes)
			break;
		const Matrix4d nominal = plane_pose(z);
		recording.views.push_back(placed_view(nominal, session));
		const Matrix3d R = turn(normal_vector(random, session.tilt)) * nominal.topLeftCorner<3, 3>();
		const Vector3d t = nominal.topRightCorner<3, 1>() + normal_vector(random, session.placement);
		recording.poses.push_back(pose(R, t));
		see_board(rig, session, recording, random);
	}
	for (int i = 0; i < session.boards; i++) {
		recording.views.push_back({});
		recording.poses.push_back(held_pose(rig, session, random));
		see_board(rig, session, recording, random);
	}
	return recording;
}

std::vector<Vector3d> table_volume()
{
	std::vector<Vector3d> positions;
	for (const double y : {0.02, 0.22, 0.42})
		for (const double z : {0.70, 1.175, 1.65, 2.125, 2.60}) {
			const double reach = std::min(0.66, 0.296 * (z + 0.4) - 0.14); // half of the common view
			for (int k = 0; k < 4; k++)
				positions.emplace_back(reach * (-1 + 2 * k / 3.0), y, z);
		}
	return positions;
}

VolumeError volume_error(const TrueRig &truth, const pong_camera camera[2], const std::vector<Vector3d> &positions)
{
	double sum = 0, squares = 0;
	int count = 0;
	for (const Vector3d &position : positions) {
		Vector2d left, right;
		Vector3d found;
		if (!truth.camera[PONG_LEFT].see(position, left) || !truth.camera[PONG_RIGHT].see(position, right))
			continue;
		if (pong_triangulate(camera, left.data(), right.data(), found.data()) != PONG_FOUND)
			return {INFINITY, INFINITY};
		sum += (found - position).norm();
		squares += (found - position).squaredNorm();
		count++;
	}
	return {sum / count, std::sqrt(squares / count)};
}

double expected_error(const pong_calibration &calibration, const std::vector<Vector3d> &positions)
{
	double squares = 0;
	int count = 0;
	for (const Vector3d &position : positions) {
		double covariance[3][3];
		if (pong_calibration_error(&calibration, position.data(), covariance) != PONG_FOUND)
			continue;
		squares += covariance[0][0] + covariance[1][1] + covariance[2][2];
		count++;
	}
	return std::sqrt(squares / count);
}

} // namespace pong
