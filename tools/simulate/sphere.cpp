#include "sphere.hpp"

#include <algorithm>
#include <cmath>

#include "lens.hpp"

namespace sim
{

namespace
{

using Eigen::Vector3f;

// Light and logo in the camera frame.
struct Shading {
	Vector3f up, towards, half, logo;
	float ambient, hemisphere, diffuse, specular, level, logo_shade;

	Shading(const Camera &camera, const Light &light, const Ball &ball)
	{
		const Eigen::Matrix3d &R = camera.R_cam_table;
		const Eigen::Vector3d to_lamp = light.towards.normalized();
		const Eigen::Vector3d to_camera = (camera.centre - ball.position).normalized();
		up = R.col(1).cast<float>();
		towards = (R * to_lamp).cast<float>();
		half = (R * (to_lamp + to_camera).normalized()).cast<float>();
		logo = (R * (ball.orientation * Eigen::Vector3d(0, 0.35, -1).normalized())).cast<float>();
		ambient = static_cast<float>(light.ambient);
		hemisphere = static_cast<float>(light.hemisphere);
		diffuse = static_cast<float>(light.diffuse);
		specular = static_cast<float>(light.specular);
		level = static_cast<float>(light.level);
		logo_shade = static_cast<float>(light.logo);
	}

	float at(float nx, float ny, float nz) const
	{
		const auto along = [&](const Vector3f &v) { return nx * v.x() + ny * v.y() + nz * v.z(); };
		float light =
			ambient + hemisphere * (0.5f + 0.5f * along(up)) + diffuse * std::max(0.0f, along(towards));
		if (logo_shade > 0 && along(logo) > 0.94f)
			light *= 1 - logo_shade;
		if (specular > 0)
			light += specular * std::pow(std::max(0.0f, along(half)), 25.0f);
		return level * light;
	}
};

// A sphere seen from the origin. Along d = (x, y, 1) the ray comes to within |c x d| / |d| of the centre c, so it meets
// the sphere where D = r^2 |d|^2 - |c x d|^2 is not negative. With d = c / c_z + (p, q, 0) the cross product has no
// cancellation, and single precision suffices.
struct Cone {
	float cx, cy, cz;     // centre, m
	float axis_x, axis_y; // ideal image point of the centre
	float r2;

	explicit Cone(const Eigen::Vector3d &centre)
		: cx(static_cast<float>(centre.x())), cy(static_cast<float>(centre.y())),
		  cz(static_cast<float>(centre.z())), axis_x(static_cast<float>(centre.x() / centre.z())),
		  axis_y(static_cast<float>(centre.y() / centre.z())), r2(static_cast<float>(ball_radius * ball_radius))
	{
	}
};

void draw_row(const Cone &cone, const Shading &shading, float samples_per_unit, float weight, Samples *s, size_t begin,
	      size_t end)
{
	const float inverse_radius = static_cast<float>(1 / ball_radius);
	for (size_t i = begin; i < end; i++) {
		const float x = s->x[i], y = s->y[i], p = x - cone.axis_x, q = y - cone.axis_y;
		const float twist = cone.cx * q - cone.cy * p;
		const float d2 = x * x + y * y + 1;
		const float D = cone.r2 * d2 - cone.cz * cone.cz * (p * p + q * q) - twist * twist;
		// Half of D's gradient: D over it, in samples, is twice the distance from the outline.
		const float gx = cone.r2 * x - cone.cz * cone.cz * p + twist * cone.cy;
		const float gy = cone.r2 * y - cone.cz * cone.cz * q - twist * cone.cx;
		const float distance = D * samples_per_unit / (2 * std::sqrt(gx * gx + gy * gy) + 1e-12f);
		const float cover = std::min(distance + 0.5f, 1.0f);
		const float along = x * cone.cx + y * cone.cy + cone.cz;
		const float t = (along - std::sqrt(std::max(D, 0.0f))) / d2;
		if (cover <= 0 || t > s->depth[i])
			continue;
		float nx = t * x - cone.cx, ny = t * y - cone.cy, nz = t - cone.cz;
		const float scale = D > 0 ? inverse_radius : 1 / std::sqrt(nx * nx + ny * ny + nz * nz);
		s->cover[i] += weight * cover;
		s->shine[i] += weight * cover * shading.at(scale * nx, scale * ny, scale * nz);
	}
}

} // namespace

void draw_sphere(const Camera &camera, const Light &light, const Ball &ball, const Share &share, Samples *samples)
{
	const Cone cone(camera.to_camera(ball.position));
	const Shading shading(camera, light, ball);
	const float samples_per_unit = static_cast<float>(camera.focal * Lens::fine);
	// The outline is nearly a circle of radius r / depth: only there is anything to do.
	const float reach = 1.3f * static_cast<float>(ball_radius) / cone.cz + 3 / samples_per_unit;
	const size_t columns = static_cast<size_t>(samples->columns);
	for (int row = share.first; row < samples->rows; row += share.skip) {
		const size_t begin = static_cast<size_t>(row) * columns, end = begin + columns;
		if (std::abs(samples->y[begin + columns / 2] - cone.axis_y) > reach)
			continue;
		const auto column = [&](float x) {
			const float from = samples->x[begin], to = samples->x[end - 1];
			const float part = (x - from) / (to - from) * static_cast<float>(columns - 1);
			return static_cast<size_t>(std::clamp(part, 0.0f, static_cast<float>(columns)));
		};
		draw_row(cone, shading, samples_per_unit, share.weight, samples, begin + column(cone.axis_x - reach),
			 begin + column(cone.axis_x + reach));
	}
}

std::vector<Eigen::Vector3d> sphere_outline(const Camera &camera, const Eigen::Vector3d &position, int count)
{
	const Eigen::Vector3d axis = position - camera.centre;
	const double sine = ball_radius / axis.norm();
	const Eigen::Vector3d middle = position - sine * sine * axis;
	const double radius = ball_radius * std::sqrt(1 - sine * sine);
	const Eigen::Vector3d across = axis.unitOrthogonal(), other = axis.normalized().cross(across);
	std::vector<Eigen::Vector3d> points;
	for (int i = 0; i < count; i++) {
		const double angle = 2 * M_PI * i / count;
		points.push_back(middle + radius * (std::cos(angle) * across + std::sin(angle) * other));
	}
	return points;
}

} // namespace sim
