#include "serve.hpp"

#include <algorithm>
#include <cmath>

#include "program.hpp"
#include "room.hpp"

namespace sim
{

namespace
{

constexpr double launch_y = 0.30, launch_z = 3.55;     // of the launcher's mouth, m
constexpr double net_clearance = ball_radius + 0.005;  // of the ball's centre, m
constexpr double lowest_hit = 0.03, highest_hit = 0.9; // y on the hit plane, m

// A launch, but for its direction.
struct Launch {
	Coefficients coefficients;
	Ball ball;
	double speed;
};

double uniform(Random &random, const std::array<double, 2> &range)
{
	return std::uniform_real_distribution<double>(0, 1)(random) * (range[1] - range[0]) + range[0];
}

double normal(Random &random, const std::array<double, 2> &mean_and_deviation)
{
	return mean_and_deviation[0] + mean_and_deviation[1] * std::normal_distribution<double>()(random);
}

Eigen::Vector3d any_direction(Random &random)
{
	const double z = uniform(random, {-1, 1}), angle = uniform(random, {0, 2 * M_PI});
	const double across = std::sqrt(1 - z * z);
	return {across * std::cos(angle), across * std::sin(angle), z};
}

Launch draw_launch(const FlightSettings &settings, Random &random)
{
	Launch launch;
	launch.coefficients.drag = normal(random, settings.drag);
	launch.coefficients.magnus = normal(random, settings.magnus);
	launch.coefficients.restitution = std::clamp(normal(random, settings.restitution), 0.0, 1.0);
	launch.coefficients.friction = std::max(normal(random, settings.friction), 0.0);
	launch.ball.position = {normal(random, {0, 0.03}), normal(random, {launch_y, 0.01}), launch_z};
	launch.ball.spin = uniform(random, {0, settings.spin}) * 2 * M_PI * any_direction(random);
	launch.speed = uniform(random, settings.speed);
	return launch;
}

Flight launched(const Launch &launch, const Planes &planes, double elevation, double azimuth)
{
	Ball ball = launch.ball;
	ball.velocity = launch.speed * Eigen::Vector3d(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
						       -std::cos(azimuth) * std::cos(elevation));
	return Flight(launch.coefficients, ball, planes);
}

bool plausible(const Flight &flight, const FlightSettings &settings)
{
	return flight.hit() && flight.bounces().size() == 1 && flight.over_net() > net_clearance &&
	       flight.hit()->position.y() >= lowest_hit && flight.hit()->position.y() <= highest_hit &&
	       flight.bounces()[0].position.z() >= settings.bounce[0] &&
	       flight.bounces()[0].position.z() <= settings.bounce[1];
}

// Where the ball first comes down, m along the table; before it where the ball flies past the robot, and beyond it
// where it falls short of the table.
double first_bounce(const Flight &flight)
{
	if (flight.bounces().empty())
		return flight.hit() ? -INFINITY : INFINITY;
	return flight.bounces()[0].position.z();
}

// The elevation of the flat arc that bounces at z: the steeper, the nearer to the robot. Bisection.
double aim_bounce(const Launch &launch, const Planes &planes, double azimuth, double z)
{
	double low = -0.4, high = 0.6;
	for (int i = 0; i < 12; i++) {
		const double middle = (low + high) / 2;
		(first_bounce(launched(launch, planes, middle, azimuth)) > z ? low : high) = middle;
	}
	return (low + high) / 2;
}

} // namespace

Flight draw_flight(const FlightSettings &settings, const Planes &planes, Random &random)
{
	for (int attempt = 0; attempt < 300; attempt++) {
		const Launch launch = draw_launch(settings, random);
		const double aim = uniform(random, settings.aim), z = uniform(random, settings.bounce);
		const double along = launch_z - planes.hit_z;
		double azimuth = std::atan2(aim - launch.ball.position.x(), along);
		double elevation = aim_bounce(launch, planes, azimuth, z);
		// Spin bends the way: aim off by what the first try missed.
		if (const auto hit = launched(launch, planes, elevation, azimuth).hit()) {
			azimuth += std::atan2(aim - hit->position.x(), along);
			elevation = aim_bounce(launch, planes, azimuth, z);
		}
		const Flight flight = launched(launch, planes, elevation, azimuth);
		if (plausible(flight, settings))
			return flight;
	}
	throw pong::Failure("no flight with the scene's speed, spin and bounce comes over the net onto the table and "
			    "to the robot");
}

} // namespace sim
