#include "ball.hpp"

#include <algorithm>
#include <cmath>

namespace sim
{

namespace
{

constexpr double gravity = 9.80665; // m/s^2
constexpr double air_density = 1.2; // kg/m^3
constexpr double ball_area = M_PI * ball_radius * ball_radius;
constexpr double ball_volume = 4.0 / 3 * M_PI * ball_radius * ball_radius * ball_radius;

} // namespace

Eigen::Vector3d acceleration(const Coefficients &coefficients, const Eigen::Vector3d &velocity,
			     const Eigen::Vector3d &spin)
{
	const double drag = coefficients.drag * air_density * ball_area / (2 * ball_mass); // 1/m
	const double weight = gravity * (1 - air_density * ball_volume / ball_mass);       // less buoyancy
	return -drag * velocity.norm() * velocity + coefficients.magnus / ball_mass * spin.cross(velocity) -
	       weight * Eigen::Vector3d::UnitY();
}

Ball fly(const Coefficients &coefficients, const Ball &ball, double seconds)
{
	const double h = seconds;
	const Eigen::Vector3d &v1 = ball.velocity;
	const Eigen::Vector3d a1 = acceleration(coefficients, v1, ball.spin);
	const Eigen::Vector3d v2 = v1 + h / 2 * a1, a2 = acceleration(coefficients, v2, ball.spin);
	const Eigen::Vector3d v3 = v1 + h / 2 * a2, a3 = acceleration(coefficients, v3, ball.spin);
	const Eigen::Vector3d v4 = v1 + h * a3, a4 = acceleration(coefficients, v4, ball.spin);
	Ball later = ball;
	later.position += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
	later.velocity += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
	const double speed = ball.spin.norm();
	if (speed > 0)
		later.orientation = Eigen::AngleAxisd(speed * h, ball.spin / speed) * ball.orientation;
	return later;
}

// The contact point slips with vc = v + w x (0, -r, 0). An impulse m dv along the table changes the spin by
// (0, -r, 0) x m dv / I and so the slip by (1 + m r^2 / I) dv, which is 2.5 dv for a hollow sphere, I = 2/3 m r^2.
Ball bounce(const Coefficients &coefficients, const Ball &ball)
{
	const double r = ball_radius;
	const Eigen::Vector3d &v = ball.velocity, &w = ball.spin;
	const Eigen::Vector3d slip(v.x() + r * w.z(), 0, v.z() - r * w.x());
	const double sliding = coefficients.friction * (1 + coefficients.restitution) * std::abs(v.y());
	const double rolling = slip.norm() / 2.5;
	Ball after = ball;
	after.velocity.y() = coefficients.restitution * std::abs(v.y());
	if (rolling > 0) {
		const Eigen::Vector3d dv = -std::min(sliding, rolling) * slip.normalized();
		after.velocity += dv;
		after.spin += 1.5 / r * Eigen::Vector3d(-dv.z(), 0, dv.x());
	}
	return after;
}

} // namespace sim
