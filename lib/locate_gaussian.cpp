// The paper's centre (section 4.3): a two-dimensional Gaussian, fitted to the brightness of the original picture.
#include <cmath>

#include "disc.hpp"
#include "locate.hpp"

namespace pong
{

// I(u, v) = A exp(B ((u - u0)^2 + (v - v0)^2)): its logarithm is linear in a0 .. a3, and
// u0 = -a2 / (2 a3), v0 = -a1 / (2 a3) (eq. 8 to 11). Places are taken from the detection's, in radii, so that the
// normal equations are well conditioned.
bool locate_gaussian(const LocateTask &task, pong_centre *centre)
{
	const pong_image &image = task.pictures.current;
	const pong_detection &detection = task.detection;
	const double radius = detection.size / 2;
	Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
	Eigen::Vector4d right = Eigen::Vector4d::Zero();
	for_each_pixel(image, detection, radius, [&](int u, int v) {
		const double x = (u - detection.u) / radius, y = (v - detection.v) / radius;
		const Eigen::Vector4d row(1, y, x, x * x + y * y);
		normal += row * row.transpose();
		right += row * std::log(std::max<double>(image.pixels[v * image.stride + u], 1));
	});
	const Eigen::Vector4d a = normal.ldlt().solve(right);
	if (!(a[3] < 0))
		return false; // not brightest inside
	const Vector2 uv = Vector2(detection.u, detection.v) - radius / (2 * a[3]) * Vector2(a[2], a[1]);
	*centre = make_centre(uv, radius, task.sigma * task.sigma * Matrix2::Identity());
	return true;
}

} // namespace pong
