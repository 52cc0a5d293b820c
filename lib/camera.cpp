#include "camera.hpp"

#include <cmath>

namespace pong
{

// P's left 3x3 part M = K R, taken apart from its last row upwards (Gram-Schmidt): the third row of R is M's, the
// second is what is left of M's second row across it, and so on.
Camera::Camera(const pong_camera &camera)
	: k1(camera.distortion[0]), k2(camera.distortion[1]), p1(camera.distortion[2]), p2(camera.distortion[3]),
	  k3(camera.distortion[4]), perfect(k1 == 0 && k2 == 0 && p1 == 0 && p2 == 0 && k3 == 0)
{
	const Matrix34 P = matrix_of(camera.P);
	const Matrix3 M = P.leftCols<3>();
	K.setZero();
	for (int i = 2; i >= 0; i--) {
		Vector3 rest = M.row(i);
		for (int j = 2; j > i; j--) {
			K(i, j) = M.row(i).dot(R.row(j));
			rest -= K(i, j) * R.row(j).transpose();
		}
		K(i, i) = rest.norm();
		R.row(i) = rest / K(i, i);
	}
	K /= K(2, 2);
	centre = -(M.inverse() * P.col(3));
}

Vector2 Camera::ideal_pixel(const Vector2 &normal) const
{
	return {K(0, 0) * normal.x() + K(0, 1) * normal.y() + K(0, 2), K(1, 1) * normal.y() + K(1, 2)};
}

// Brown's model, with OpenCV's names.
Vector2 Camera::distort(const Vector2 &normal) const
{
	const double x = normal.x(), y = normal.y(), r2 = x * x + y * y;
	const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
	return ideal_pixel({x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
			    y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y});
}

Vector2 Camera::undistort(const Vector2 &pixel) const
{
	const double y_target = (pixel.y() - K(1, 2)) / K(1, 1);
	const double x_target = (pixel.x() - K(0, 2) - K(0, 1) * y_target) / K(0, 0);
	Vector2 normal(x_target, y_target);
	if (perfect)
		return normal;
	for (int i = 0; i < 12; i++) {
		const double x = normal.x(), y = normal.y(), r2 = x * x + y * y;
		const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
		const double slope = 2 * (k1 + r2 * (2 * k2 + r2 * 3 * k3)); // of radial, per x dx + y dy
		const Vector2 residual(x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x) - x_target,
				       y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y - y_target);
		Matrix2 jacobian;
		jacobian << radial + x * x * slope + 2 * p1 * y + 6 * p2 * x, x * y * slope + 2 * p1 * x + 2 * p2 * y,
			x * y * slope + 2 * p1 * x + 2 * p2 * y, radial + y * y * slope + 6 * p1 * y + 2 * p2 * x;
		const Vector2 step = jacobian.inverse() * residual;
		normal -= step;
		if (step.squaredNorm() < 1e-24)
			break;
	}
	return normal;
}

Vector3 Camera::ray(const Vector2 &pixel) const
{
	return (R.transpose() * undistort(pixel).homogeneous()).normalized();
}

double Camera::depth(const Vector3 &position) const
{
	return R.row(2).dot(position - centre);
}

Vector2 Camera::project(const Vector3 &position) const
{
	const Vector2 normal = (R * (position - centre)).hnormalized();
	return perfect ? ideal_pixel(normal) : distort(normal);
}

double Camera::apparent_size(double diameter, double at_depth) const
{
	return std::sqrt(K(0, 0) * K(1, 1)) * diameter / at_depth;
}

} // namespace pong

using namespace pong;

int pong_project(const pong_camera *camera, const double position[3], double uv[2])
{
	const Camera parts(*camera);
	if (!(parts.depth(vector_of(position)) > 0))
		return PONG_NONE;
	const Vector2 pixel = parts.project(vector_of(position));
	uv[0] = pixel.x();
	uv[1] = pixel.y();
	return PONG_FOUND;
}

void pong_undistort(const pong_camera *camera, const double uv[2], double ideal_uv[2])
{
	const Camera parts(*camera);
	const Vector2 pixel = parts.ideal_pixel(parts.undistort({uv[0], uv[1]}));
	ideal_uv[0] = pixel.x();
	ideal_uv[1] = pixel.y();
}

void pong_ray(const pong_camera *camera, const double uv[2], double centre[3], double direction[3])
{
	const Camera parts(*camera);
	store(parts.centre, centre);
	store(parts.ray({uv[0], uv[1]}), direction);
}

double pong_apparent_size(const pong_camera *camera, const double position[3], double diameter)
{
	const Camera parts(*camera);
	const double depth = parts.depth(vector_of(position));
	return depth > 0 ? parts.apparent_size(diameter, depth) : 0;
}
