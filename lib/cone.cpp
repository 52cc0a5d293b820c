// All rays that touch a sphere make the same angle alpha with the ray to its centre. With unit rays d_i and the unit
// vector a to the centre, d_i . a = cos alpha; so w = a / cos alpha solves d_i . w = 1, linear in w. The sphere's
// centre is seen along w itself, which the middle of the elliptic outline is not (0.1 px at 1 m and 16 degrees off the
// axis). A small change of the angle shows as d . w - 1 = -tan(alpha) (beta - alpha), and f (beta - alpha) pixels.
#include "cone.hpp"

#include <algorithm>
#include <cmath>

namespace pong
{

namespace
{

const int points_needed = 8;
const int rounds = 5;           // of fitting and trimming
const double trim = 3.5;        // a point farther off than so many typical residuals is not used,
const double trim_at_least = 2; // nor one farther than so many of its deviations

// The unit rays, in a frame about their mean: there the x and y of all are small, and w is (0, 0, 1) but for little.
struct Rays {
	Matrix3 frame; // rows: the axes of that frame in the camera's
	Vector3 ray[edge_points_max];
};

void make_rays(const Camera &camera, const EdgePoint *points, int count, Rays &rays)
{
	Vector3 mean = Vector3::Zero();
	for (int i = 0; i < count; i++) {
		rays.ray[i] = camera.undistort(points[i].pixel).homogeneous().normalized();
		mean += rays.ray[i];
	}
	rays.frame.row(2) = mean.normalized();
	rays.frame.row(0) = rays.frame.row(2).cross(Vector3::UnitY().transpose()).normalized();
	rays.frame.row(1) = rays.frame.row(2).cross(rays.frame.row(0));
	for (int i = 0; i < count; i++)
		rays.ray[i] = rays.frame * rays.ray[i];
}

// d . w = 1 for w = (0, 0, 1) + x, weighted: the normal matrix, in px^-2 times the square of f / tan(alpha).
bool solve(const Rays &rays, const EdgePoint *points, int count, Matrix3 &normal, Vector3 &w)
{
	normal.setZero();
	Vector3 right = Vector3::Zero();
	int used = 0;
	for (int i = 0; i < count; i++) {
		if (std::isinf(points[i].deviation))
			continue;
		const Vector3 &d = rays.ray[i];
		const double weight = 1 / (points[i].deviation * points[i].deviation);
		// 1 - d_z without cancellation.
		const double sine2 = d.x() * d.x() + d.y() * d.y();
		normal += weight * d * d.transpose();
		right += weight * sine2 / (1 + d.z()) * d;
		used++;
	}
	if (used < points_needed)
		return false;
	w = Vector3::UnitZ() + normal.ldlt().solve(right);
	return w.allFinite() && w.squaredNorm() > 1;
}

double median(double *values, int count)
{
	std::nth_element(values, values + count / 2, values + count);
	return values[count / 2];
}

} // namespace

bool fit_cone(const Camera &camera, EdgePoint *points, int count, ConeFit *fit)
{
	if (count < points_needed)
		return false;
	Rays rays;
	make_rays(camera, points, count, rays);
	const double focal = std::sqrt(camera.K(0, 0) * camera.K(1, 1));
	double deviation[edge_points_max], residual[edge_points_max], sorted[edge_points_max];
	for (int i = 0; i < count; i++)
		deviation[i] = points[i].deviation;
	Matrix3 normal;
	Vector3 w;
	double scale = 0; // pixels of residual per unit of d . w - 1
	for (int round = 0; round < rounds; round++) {
		if (!solve(rays, points, count, normal, w))
			return false;
		scale = focal / std::sqrt(w.squaredNorm() - 1);
		int used = 0;
		for (int i = 0; i < count; i++) {
			residual[i] = std::abs(rays.ray[i].dot(w) - 1) * scale / deviation[i];
			if (!std::isinf(points[i].deviation))
				sorted[used++] = residual[i];
		}
		const double limit = std::max(trim_at_least, trim * 1.4826 * median(sorted, used));
		bool changed = false;
		for (int i = 0; i < count; i++) {
			const double now = residual[i] <= limit ? deviation[i] : INFINITY;
			changed |= now != points[i].deviation;
			points[i].deviation = now;
		}
		if (!changed)
			break;
	}
	double sum = 0;
	fit->used = 0;
	for (int i = 0; i < count; i++)
		if (!std::isinf(points[i].deviation)) {
			sum += residual[i] * residual[i];
			fit->used++;
		}
	if (fit->used < points_needed)
		return false;
	fit->residual = std::sqrt(sum / (fit->used - 3));
	const Vector3 towards = rays.frame.transpose() * w;
	if (!(towards.z() > 0))
		return false;
	const Vector2 normal_point = towards.hnormalized();
	fit->centre = camera.distort(normal_point);
	fit->radius = focal * std::sqrt(w.squaredNorm() - 1) * std::sqrt(1 + normal_point.squaredNorm());
	// The covariance of w, seen through the projection.
	Eigen::Matrix<double, 2, 3> projection;
	projection << camera.K(0, 0), camera.K(0, 1), 0, 0, camera.K(1, 1), 0;
	projection.col(2) = -(projection.leftCols<2>() * normal_point);
	projection /= towards.z();
	const Eigen::Matrix<double, 2, 3> jacobian = projection * rays.frame.transpose();
	fit->covariance = jacobian * normal.inverse() * jacobian.transpose() / (scale * scale);
	return true;
}

} // namespace pong
