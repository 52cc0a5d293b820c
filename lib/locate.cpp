// The ball's centre to a part of a pixel (paper, section 4.3): on the original picture, not on the binary one.
#include <algorithm>
#include <cmath>

#include "camera.hpp"
#include "difference.hpp"
#include "pongeye.h"

namespace pong
{

namespace
{

using Vector4 = Eigen::Vector4d;
using Matrix4 = Eigen::Matrix4d;

// Call visit(u, v) for every pixel of the picture whose centre lies within `radius` of the detection.
template<class Visit>
void for_each_pixel(const pong_image &image, const pong_detection &detection, double radius, Visit visit)
{
	const int u_begin = std::max(0, static_cast<int>(std::ceil(detection.u - radius)));
	const int u_end = std::min(image.width - 1, static_cast<int>(std::floor(detection.u + radius)));
	const int v_begin = std::max(0, static_cast<int>(std::ceil(detection.v - radius)));
	const int v_end = std::min(image.height - 1, static_cast<int>(std::floor(detection.v + radius)));
	for (int v = v_begin; v <= v_end; v++)
		for (int u = u_begin; u <= u_end; u++)
			if (std::hypot(u - detection.u, v - detection.v) <= radius)
				visit(u, v);
}

// I(u, v) = A exp(B ((u - u0)^2 + (v - v0)^2)): its logarithm is linear in a0 .. a3, and
// u0 = -a2 / (2 a3), v0 = -a1 / (2 a3) (eq. 8 to 11). Places are taken from the detection's, in radii, so that the
// normal equations are well conditioned.
bool fit_gaussian(const pong_image &image, const pong_detection &detection, Vector2 &centre)
{
	const double radius = detection.size / 2;
	Matrix4 normal = Matrix4::Zero();
	Vector4 right = Vector4::Zero();
	for_each_pixel(image, detection, radius, [&](int u, int v) {
		const double x = (u - detection.u) / radius, y = (v - detection.v) / radius;
		const Vector4 row(1, y, x, x * x + y * y);
		normal += row * row.transpose();
		right += row * std::log(std::max<double>(image.pixels[v * image.stride + u], 1));
	});
	const Vector4 a = normal.ldlt().solve(right);
	if (!(a[3] < 0))
		return false; // not brightest inside
	centre = {detection.u - radius * a[2] / (2 * a[3]), detection.v - radius * a[1] / (2 * a[3])};
	return true;
}

// The centroid of how much of each pixel the ball covers: what is new there, over the ball's contrast. What is newer
// than `full` covers it wholly, so that shading inside of the ball does not pull.
bool fit_centroid(const pong_pictures &pictures, const pong_detection &detection, Vector2 &centre)
{
	const auto value = [](const pong_image &image, int u, int v) { return image.pixels[v * image.stride + u]; };
	const double full = 0.3 * detection.contrast, none = 0.1 * detection.contrast;
	double weight = 0;
	Vector2 sum(0, 0);
	for_each_pixel(pictures.current, detection, 0.65 * detection.size + 1.5, [&](int u, int v) {
		const double difference = beyond_both(value(pictures.current, u, v), value(pictures.earlier[0], u, v),
						      value(pictures.earlier[1], u, v));
		const double cover = std::clamp((difference - none) / (full - none), 0.0, 1.0);
		weight += cover;
		sum += cover * Vector2(u, v);
	});
	if (!(weight > 1))
		return false;
	centre = sum / weight;
	return true;
}

} // namespace

} // namespace pong

using namespace pong;

int pong_locate(const pong_pictures *pictures, const pong_detection *detection, const pong_settings *settings,
		pong_centre *centre)
{
	Vector2 uv;
	const bool found = settings->locate.method == PONG_LOCATE_GAUSSIAN
				   ? fit_gaussian(pictures->current, *detection, uv)
				   : fit_centroid(*pictures, *detection, uv);
	// A centre outside of the ball is a fit gone wrong.
	if (!found || !(std::hypot(uv.x() - detection->u, uv.y() - detection->v) < detection->size / 2))
		return PONG_NONE;
	const double variance = settings->locate.sigma * settings->locate.sigma;
	*centre = {uv.x(), uv.y(), detection->size / 2, {{variance, 0}, {0, variance}}};
	return PONG_FOUND;
}
