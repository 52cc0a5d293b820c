#include "volume.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "program.hpp"

namespace calibrate
{

namespace
{

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Grid = std::vector<std::array<double, 3>>;

// The place that a camera sees in a part (0 to 1) of its picture, so far along the ray.
Vector3d place_at(const pong_camera &camera, double right, double down, double distance)
{
	const double uv[2] = {right * (camera.width - 1), down * (camera.height - 1)};
	Vector3d centre, direction;
	pong_ray(&camera, uv, centre.data(), direction.data());
	return centre + distance * direction;
}

// The nearest and the farthest board, from the left camera.
std::pair<double, double> distances(const Session &session)
{
	const double middle[2] = {0, 0};
	Vector3d centre, direction;
	pong_ray(&session.calibration.camera[PONG_LEFT], middle, centre.data(), direction.data());
	double nearest = 1e9, farthest = 0;
	for (const size_t i : session.used) {
		const auto view = static_cast<size_t>(std::find(session.used.begin(), session.used.end(), i) -
						      session.used.begin());
		const auto &pose = session.results[view].pose;
		const double distance = (Vector3d(pose[0][3], pose[1][3], pose[2][3]) - centre).norm();
		nearest = std::min(nearest, distance);
		farthest = std::max(farthest, distance);
	}
	return {nearest, farthest};
}

// The directions of a picture's axes and of the camera's own, in the table frame.
Matrix3d camera_axes(const pong_camera &camera)
{
	const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> P(&camera.P[0][0]);
	const Vector3d forward = P.block<1, 3>(2, 0).transpose().normalized();
	const Vector3d row = P.block<1, 3>(0, 0).transpose();
	const Vector3d right = (row - row.dot(forward) * forward).normalized();
	Matrix3d axes;
	axes << right, forward.cross(right), forward;
	return axes;
}

struct Pose {
	double right, down, distance; // middle of the board: parts of the picture, m
	int lean;                     // 0: facing the camera; 1 .. 4: leaning to one side
};

const char *const leans[] = {"facing the cameras", "its top leaning away", "its top leaning towards them",
			     "its right side turned away", "its left side turned away"};

std::string describe(const Pose &pose)
{
	const char *rows[] = {"upper", "middle", "lower"}, *columns[] = {"left", "middle", "right"};
	return pong::format("%.1f m away, %s %s of the left picture, %s", pose.distance,
			    rows[static_cast<int>(pose.down * 3)], columns[static_cast<int>(pose.right * 3)],
			    leans[pose.lean]);
}

// The corners that both cameras would see; none where the board is not wholly in both pictures.
std::vector<pong_corner> corners_at(const pong_camera camera[2], const BoardSize &board, const double pose[3][4])
{
	std::vector<pong_corner> corners;
	const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> matrix(&pose[0][0]);
	for (const pong_side side : {PONG_LEFT, PONG_RIGHT})
		for (int i = 0; i < board.columns * board.rows; i++) {
			const Vector3d place((i % board.columns - (board.columns - 1) / 2.0) * board.square,
					     (i / board.columns - (board.rows - 1) / 2.0) * board.square, 0);
			const Vector3d point = matrix * place.homogeneous();
			double uv[2];
			if (pong_project(&camera[side], point.data(), uv) != PONG_FOUND || uv[0] < 0 || uv[1] < 0 ||
			    uv[0] > camera[side].width - 1 || uv[1] > camera[side].height - 1)
				return {};
			corners.push_back({0, side, i, {place.x(), place.y(), 0}, {uv[0], uv[1]}, 1});
		}
	return corners;
}

double mean_with(const Session &session, const BoardSize &board, const Pose &pose, const Grid &grid)
{
	const pong_camera *camera = session.calibration.camera;
	const double angle = 35 * M_PI / 180;
	const Vector3d about[] = {Vector3d::Zero(), {angle, 0, 0}, {-angle, 0, 0}, {0, -angle, 0}, {0, angle, 0}};
	Matrix3d R = camera_axes(camera[PONG_LEFT]);
	if (pose.lean)
		R *= Eigen::AngleAxisd(about[pose.lean].norm(), about[pose.lean].normalized()).toRotationMatrix();
	const Vector3d t = place_at(camera[PONG_LEFT], pose.right, pose.down, pose.distance);
	double matrix[3][4];
	for (int i = 0; i < 3; i++)
		for (int j = 0; j < 4; j++)
			matrix[i][j] = j < 3 ? R(i, j) : t[i];
	const auto corners = corners_at(camera, board, matrix);
	if (corners.empty())
		return NAN;
	pong_calibration after;
	pong_calibration_expect(&session.calibration, matrix, corners.data(), static_cast<int>(corners.size()), &after);
	return expect_error(after, grid).mean;
}

} // namespace

Grid table_grid()
{
	Grid grid;
	for (const double y : {0.02, 0.22, 0.42})
		for (int i = 0; i <= 10; i++)
			for (int j = 0; j <= 6; j++)
				grid.push_back({-0.7625 + 1.525 * j / 6, y, 2.74 * i / 10});
	return grid;
}

Grid volume_grid(const Session &session, bool table)
{
	if (table)
		return table_grid();
	Grid grid;
	const auto [nearest, farthest] = distances(session);
	for (int k = 0; k <= 4; k++)
		for (int i = 0; i <= 6; i++)
			for (int j = 0; j <= 6; j++) {
				const Vector3d place = place_at(session.calibration.camera[PONG_LEFT], j / 6.0, i / 6.0,
								nearest + (farthest - nearest) * k / 4);
				grid.push_back({place.x(), place.y(), place.z()});
			}
	return grid;
}

Volume expect_error(const pong_calibration &calibration, const Grid &grid)
{
	Volume volume = {{}, 0, 0, 0};
	int count = 0;
	for (const auto &position : grid) {
		ExpectedError error = {position, NAN, {NAN, NAN, NAN}};
		double covariance[3][3];
		if (pong_calibration_error(&calibration, position.data(), covariance) == PONG_FOUND) {
			error.total = 1e3 * std::sqrt(covariance[0][0] + covariance[1][1] + covariance[2][2]);
			for (int axis = 0; axis < 3; axis++)
				error.along[axis] = 1e3 * std::sqrt(covariance[axis][axis]);
			volume.mean += error.total;
			volume.worst = std::max(volume.worst, error.total);
			count++;
		}
		volume.places.push_back(error);
	}
	volume.mean = count ? volume.mean / count : NAN;
	volume.seen = static_cast<double>(count) / static_cast<double>(grid.size());
	return volume;
}

std::vector<Advice> advise(const Session &session, const BoardSize &board, const Grid &grid)
{
	std::vector<Advice> advice;
	const auto [nearest, farthest] = distances(session);
	for (const double distance : {nearest, (nearest + farthest) / 2, farthest})
		for (const double down : {0.25, 0.5, 0.75})
			for (const double right : {0.25, 0.5, 0.75})
				for (int lean = 0; lean < 5; lean++) {
					const Pose pose = {right, down, distance, lean};
					const double mean = mean_with(session, board, pose, grid);
					if (std::isfinite(mean))
						advice.push_back({describe(pose), mean});
				}
	std::sort(advice.begin(), advice.end(), [](const Advice &a, const Advice &b) { return a.mean < b.mean; });
	advice.resize(std::min<size_t>(advice.size(), 3));
	return advice;
}

} // namespace calibrate
