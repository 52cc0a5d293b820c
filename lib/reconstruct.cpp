// From two centres to a point (paper, section 5 and appendix).
#include <algorithm>
#include <cmath>

#include "camera.hpp"
#include "light.hpp"
#include "locate.hpp"

namespace pong
{

namespace
{

Matrix3 cross_matrix(const Vector3 &d)
{
	Matrix3 matrix;
	matrix << 0, -d.z(), d.y(), d.z(), 0, -d.x(), -d.y(), d.x(), 0;
	return matrix;
}

// F = [M2r - M1r M1l^-1 M2l]x M1r M1l^-1 for M = [M1 | M2] (appendix).
Matrix3 fundamental(const pong_camera camera[2])
{
	const Matrix34 left = matrix_of(camera[PONG_LEFT].P), right = matrix_of(camera[PONG_RIGHT].P);
	const Matrix3 right_from_left = right.leftCols<3>() * left.leftCols<3>().inverse();
	return cross_matrix(right.col(3) - right_from_left * left.col(3)) * right_from_left;
}

Vector2 ideal(const pong_camera &camera, double u, double v)
{
	const double uv[2] = {u, v};
	double out[2] = {u, v};
	for (const double coefficient : camera.distortion)
		if (coefficient != 0) {
			pong_undistort(&camera, uv, out);
			break;
		}
	return {out[0], out[1]};
}

// The two ideal pixels of one ball.
struct Pair {
	Vector2 pixel[2];
};

Pair ideal_pair(const pong_camera camera[2], const double left_uv[2], const double right_uv[2])
{
	return {{ideal(camera[PONG_LEFT], left_uv[0], left_uv[1]),
		 ideal(camera[PONG_RIGHT], right_uv[0], right_uv[1])}};
}

Pair ideal_pair(const pong_camera camera[2], const pong_centre centre[2])
{
	const double left_uv[2] = {centre[PONG_LEFT].u, centre[PONG_LEFT].v};
	const double right_uv[2] = {centre[PONG_RIGHT].u, centre[PONG_RIGHT].v};
	return ideal_pair(camera, left_uv, right_uv);
}

double epipolar_distance(const pong_camera camera[2], const Pair &pair)
{
	const Vector3 line = fundamental(camera) * pair.pixel[PONG_LEFT].homogeneous();
	const double sign = line.y() < 0 || (line.y() == 0 && line.x() < 0) ? -1 : 1;
	return sign * line.dot(pair.pixel[PONG_RIGHT].homogeneous()) / line.head<2>().norm();
}

// s q = M Q in both cameras: two rows per camera, u M3 - M1 and v M3 - M2, solved for Q by least squares
// (eq. 14 and 15). In front of both cameras, or there is no such point.
bool triangulate(const pong_camera camera[2], const Pair &pair, Vector3 &position)
{
	Eigen::Matrix<double, 4, 3> rows;
	Eigen::Vector4d right_side;
	for (int side = 0; side < 2; side++) {
		const Matrix34 P = matrix_of(camera[side].P);
		for (int axis = 0; axis < 2; axis++) {
			const Eigen::RowVector4d row = pair.pixel[side][axis] * P.row(2) - P.row(axis);
			rows.row(2 * side + axis) = row.head<3>();
			right_side[2 * side + axis] = -row[3];
		}
	}
	const Matrix3 normal = rows.transpose() * rows;
	if (!(std::abs(normal.determinant()) > 1e-12 * std::pow(normal.trace() / 3, 3)))
		return false; // the rays are parallel
	position = normal.ldlt().solve(rows.transpose() * right_side);
	for (int side = 0; side < 2; side++)
		if (!(matrix_of(camera[side].P).row(2).dot(position.homogeneous()) > 0))
			return false;
	return true;
}

// How a camera's ideal pixel moves with the point: d(u, v)/d(x, y, z).
Eigen::Matrix<double, 2, 3> projection_jacobian(const Matrix34 &P, const Vector3 &position)
{
	const Vector3 q = P * position.homogeneous();
	Eigen::Matrix<double, 2, 3> jacobian;
	for (int axis = 0; axis < 2; axis++)
		jacobian.row(axis) = (P.row(axis).head<3>() - q[axis] / q.z() * P.row(2).head<3>()) / q.z();
	return jacobian;
}

using Matrix4 = Eigen::Matrix4d;
using Jacobian = Eigen::Matrix<double, 4, 3>;

// Of both centres. With covariances L L', what they err alike is the part `common` of L_left L_right'.
Matrix4 centres_covariance(const pong_centre centre[2])
{
	Matrix4 covariance;
	Matrix2 root[2];
	for (int side = 0; side < 2; side++) {
		covariance.block<2, 2>(2 * side, 2 * side) = covariance_of(centre[side]);
		root[side] = covariance_of(centre[side]).llt().matrixL();
	}
	const double common = std::min(centre[PONG_LEFT].common, centre[PONG_RIGHT].common);
	covariance.topRightCorner<2, 2>() = common * root[PONG_LEFT] * root[PONG_RIGHT].transpose();
	covariance.bottomLeftCorner<2, 2>() = covariance.topRightCorner<2, 2>().transpose();
	return covariance;
}

// A rig is never calibrated so well that the centres of one ball lie on each other's epipolar lines to a hundredth of a
// pixel, as they are found. Were that distance taken for an error of the centres, it would move the point in depth by
// as much as the centres' covariances say that u goes with v. So what is across the epipolar lines may differ by
// `distance` (standard deviation) for the rig's sake.
Matrix4 rig_covariance(const pong_camera camera[2], const Pair &pair, double distance)
{
	const Matrix3 F = fundamental(camera);
	Eigen::Vector4d across;
	across << (F.transpose() * pair.pixel[PONG_RIGHT].homogeneous()).head<2>().normalized(),
		(F * pair.pixel[PONG_LEFT].homogeneous()).head<2>().normalized();
	return distance * distance / 4 * across * across.transpose();
}

// How both ideal pixels move with the point.
Jacobian pair_jacobian(const pong_camera camera[2], const Vector3 &position)
{
	Jacobian jacobian;
	for (int side = 0; side < 2; side++)
		jacobian.middleRows<2>(2 * side) = projection_jacobian(matrix_of(camera[side].P), position);
	return jacobian;
}

// The covariance that the two centres leave to the point: the inverse of the information that they carry.
Matrix3 point_covariance(const pong_camera camera[2], const Matrix4 &information, const Vector3 &position)
{
	const Jacobian jacobian = pair_jacobian(camera, position);
	return (jacobian.transpose() * information * jacobian).inverse();
}

// The point that makes both centres most likely, from the linear one on: Gauss-Newton on what the pixels miss, in units
// of their covariances.
Vector3 most_likely(const pong_camera camera[2], const Pair &pair, const Matrix4 &information, Vector3 position)
{
	const int rounds = 2; // the linear point is close
	for (int round = 0; round < rounds; round++) {
		const Jacobian jacobian = pair_jacobian(camera, position);
		Eigen::Vector4d missed;
		for (int side = 0; side < 2; side++)
			missed.segment<2>(2 * side) =
				pair.pixel[side] - (matrix_of(camera[side].P) * position.homogeneous()).hnormalized();
		const Matrix3 normal = jacobian.transpose() * information * jacobian;
		position += normal.ldlt().solve(jacobian.transpose() * information * missed);
	}
	return position;
}

bool size_agrees(const pong_camera &camera, const Vector3 &position, double diameter, const pong_centre &centre,
		 double tolerance)
{
	const double expected = pong_apparent_size(&camera, position.data(), diameter);
	return std::abs(2 * centre.radius - expected) <= tolerance * expected;
}

} // namespace

} // namespace pong

using namespace pong;

void pong_fundamental(const pong_camera camera[2], double F[3][3])
{
	store(fundamental(camera), F);
}

double pong_epipolar_distance(const pong_camera camera[2], const double left_uv[2], const double right_uv[2])
{
	return epipolar_distance(camera, ideal_pair(camera, left_uv, right_uv));
}

int pong_triangulate(const pong_camera camera[2], const double left_uv[2], const double right_uv[2], double position[3])
{
	Vector3 point;
	if (!triangulate(camera, ideal_pair(camera, left_uv, right_uv), point))
		return PONG_NONE;
	store(point, position);
	return PONG_FOUND;
}

int pong_reconstruct(const pong_rig *rig, const pong_centre *left, const pong_centre *right,
		     const pong_settings *settings, pong_point *point)
{
	pong_centre centre[2] = {*left, *right};
	Pair pair = ideal_pair(rig->camera, centre);
	Vector3 position;
	const double reach =
		settings->reconstruct.epipolar + settings->reconstruct.epipolar_size * (left->radius + right->radius);
	if (!(std::abs(epipolar_distance(rig->camera, pair)) <= reach) || !triangulate(rig->camera, pair, position))
		return PONG_NONE;
	for (int side = 0; side < 2; side++)
		if (!size_agrees(rig->camera[side], position, rig->ball.diameter, centre[side],
				 settings->reconstruct.size))
			return PONG_NONE;
	const bool likely = settings->reconstruct.method == PONG_RECONSTRUCT_LIKELY;
	Matrix4 covariance = centres_covariance(centre);
	if (likely && join_lights(rig->camera, position, centre, &covariance))
		pair = ideal_pair(rig->camera, centre);
	covariance += rig_covariance(rig->camera, pair, settings->reconstruct.epipolar);
	const Matrix4 information = covariance.inverse();
	if (likely)
		position = most_likely(rig->camera, pair, information, position);
	store(position, point->position);
	store(point_covariance(rig->camera, information, position), point->covariance);
	return PONG_FOUND;
}
