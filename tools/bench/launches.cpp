#include "launches.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "program.hpp"

namespace bench
{

namespace
{

constexpr int parameter_count = 13; // position, velocity, spin, four coefficients
const sim::Planes planes = {0, -0.4};
const int64_t first_utime = 1000000000;

using Parameters = Eigen::Matrix<double, parameter_count, 1>;

Parameters parameters_of(const Launch &launch)
{
	const sim::Ball ball = launch.flight.at(0);
	Parameters parameters;
	parameters << ball.position, ball.velocity, ball.spin, launch.coefficients.drag, launch.coefficients.magnus,
		launch.coefficients.restitution, launch.coefficients.friction;
	return parameters;
}

sim::Flight fly(const Parameters &parameters)
{
	sim::Ball ball;
	ball.position = parameters.segment<3>(0);
	ball.velocity = parameters.segment<3>(3);
	ball.spin = parameters.segment<3>(6);
	return sim::Flight({parameters[9], parameters[10], parameters[11], parameters[12]}, ball, planes);
}

double normal(sim::Random &random, double mean, double deviation)
{
	return mean + deviation * std::normal_distribution<double>()(random);
}

// The ball whole in both pictures.
bool seen(const sim::Rig &rig, const Eigen::Vector3d &position)
{
	for (const sim::Camera &camera : rig) {
		Eigen::Vector2d uv;
		if (!camera.project(position, &uv))
			return false;
		const double radius = camera.focal * sim::ball_radius / camera.to_camera(position).z() + 1;
		if (uv.x() < radius || uv.x() > camera.width - 1 - radius || uv.y() < radius ||
		    uv.y() > camera.height - 1 - radius)
			return false;
	}
	return true;
}

// Of both cameras' pixels: d(u_l, v_l, u_r, v_r) / d(x, y, z), by differences.
Eigen::Matrix<double, 4, 3> pixel_rates(const sim::Rig &rig, const Eigen::Vector3d &position)
{
	const double step = 1e-5;
	Eigen::Matrix<double, 4, 3> rates;
	for (int axis = 0; axis < 3; axis++)
		for (int side = 0; side < 2; side++) {
			Eigen::Vector2d more, less;
			rig[side].project(position + step * Eigen::Vector3d::Unit(axis), &more);
			rig[side].project(position - step * Eigen::Vector3d::Unit(axis), &less);
			rates.block<2, 1>(2 * side, axis) = (more - less) / (2 * step);
		}
	return rates;
}

Parameters steps(const Parameters &parameters)
{
	Parameters steps;
	steps << Eigen::Vector3d::Constant(1e-5), Eigen::Vector3d::Constant(1e-4), Eigen::Vector3d::Constant(0.05),
		1e-4, 1e-3 * parameters[10], 1e-4, 1e-4;
	return steps;
}

// The mean length of a two-dimensional normal vector.
double mean_length(const Eigen::Matrix2d &covariance)
{
	const Eigen::Vector2d variance = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(covariance).eigenvalues();
	const int directions = 360;
	double sum = 0;
	for (int i = 0; i < directions; i++) {
		const double angle = M_PI * (i + 0.5) / directions;
		sum += std::sqrt(variance[0] * std::pow(std::cos(angle), 2) +
				 variance[1] * std::pow(std::sin(angle), 2));
	}
	return std::sqrt(M_PI / 2) * sum / directions;
}

} // namespace

// The spin's size is uniform up to the greatest, its axis any: a component's variance is a third of the size's mean
// square.
Spread spread_of(const LaunchSettings &settings)
{
	return {2 * M_PI * settings.spin / 3, 0.047, 0.15e-6, 0.02, 0.05};
}

std::vector<Launch> draw_launches(const sim::Rig &rig, const LaunchSettings &settings)
{
	const Spread spread = spread_of(settings);
	const sim::Coefficients mean;
	sim::Random random(settings.seed);
	std::vector<Launch> launches;
	for (int i = 0; i < 66; i++) {
		const double speeds[] = {7, 9.5, 13}, aim = -0.45 + 0.09 * (i % 11);
		const double speed = normal(random, speeds[i / 22], 0.01 * speeds[i / 22]);
		const sim::Coefficients drawn = {normal(random, mean.drag, spread.drag),
						 normal(random, mean.magnus, spread.magnus),
						 std::min(normal(random, mean.restitution, spread.restitution), 1.0),
						 std::max(normal(random, mean.friction, spread.friction), 0.05)};
		sim::FlightSettings how;
		how.speed = {speed, speed};
		how.aim = {aim, aim};
		how.spin = settings.spin;
		how.drag = {drawn.drag, 0};
		how.magnus = {drawn.magnus, 0};
		how.restitution = {drawn.restitution, 0};
		how.friction = {drawn.friction, 0};
		Launch launch = {drawn, sim::draw_flight(how, planes, random), {}};
		const double begin = std::uniform_real_distribution<double>(0, 1 / settings.rate)(random);
		for (double time = begin; time < launch.flight.hit()->time; time += 1 / settings.rate)
			if (seen(rig, launch.flight.at(time).position))
				launch.times.push_back(time);
		launches.push_back(launch);
	}
	return launches;
}

std::vector<pong_point> measure(const sim::Rig &sim_rig, const pong_rig &rig, const Launch &launch,
				const LaunchSettings &settings, sim::Random &random)
{
	pong_settings library;
	pong_settings_defaults(PONG_BEST, &library);
	library.reconstruct.epipolar = 10 * settings.noise + 1;
	std::vector<pong_point> points;
	for (size_t i = 0; i < launch.times.size(); i++) {
		const Eigen::Vector3d position = launch.flight.at(launch.times[i]).position;
		pong_centre centre[2] = {};
		for (int side = 0; side < 2; side++) {
			Eigen::Vector2d uv;
			sim_rig[side].project(position, &uv);
			centre[side].u = normal(random, uv.x(), settings.noise);
			centre[side].v = normal(random, uv.y(), settings.noise);
			centre[side].radius =
				sim_rig[side].focal * sim::ball_radius / sim_rig[side].to_camera(position).z();
			centre[side].covariance[0][0] = centre[side].covariance[1][1] = std::pow(settings.noise, 2);
		}
		pong_point point = {};
		if (!pong_reconstruct(&rig, &centre[PONG_LEFT], &centre[PONG_RIGHT], &library, &point))
			continue;
		point.utime = first_utime + std::llround(1e6 * launch.times[i]);
		point.frame = static_cast<int64_t>(i);
		points.push_back(point);
	}
	return points;
}

Bound prediction_bound(const sim::Rig &rig, const Launch &launch, double latest, const LaunchSettings &settings)
{
	const Parameters parameters = parameters_of(launch), step = steps(parameters);
	std::vector<sim::Flight> more, less;
	Eigen::Matrix<double, 3, parameter_count> hit_rates; // x, y, time
	for (int i = 0; i < parameter_count; i++) {
		more.push_back(fly(parameters + step[i] * Parameters::Unit(i)));
		less.push_back(fly(parameters - step[i] * Parameters::Unit(i)));
		if (!more[i].hit() || !less[i].hit())
			throw pong::Failure("a flight at the border of the hit plane has no bound");
		hit_rates.col(i) << (more[i].hit()->position - less[i].hit()->position).head<2>(),
			more[i].hit()->time - less[i].hit()->time;
		hit_rates.col(i) /= 2 * step[i];
	}
	const Spread spread = spread_of(settings);
	Parameters sigma;
	sigma << Eigen::Vector3d::Constant(10), Eigen::Vector3d::Constant(10), Eigen::Vector3d::Constant(spread.spin),
		spread.drag, spread.magnus, spread.restitution, spread.friction;
	Eigen::Matrix<double, parameter_count, parameter_count> information =
		sigma.array().square().inverse().matrix().asDiagonal();
	for (const double time : launch.times) {
		if (time > latest)
			break;
		Eigen::Matrix<double, 3, parameter_count> rates;
		for (int i = 0; i < parameter_count; i++)
			rates.col(i) = (more[i].at(time).position - less[i].at(time).position) / (2 * step[i]);
		const Eigen::Matrix<double, 4, parameter_count> pixels =
			pixel_rates(rig, launch.flight.at(time).position) * rates / settings.noise;
		information += pixels.transpose() * pixels;
	}
	const Eigen::Matrix3d covariance = hit_rates * information.ldlt().solve(hit_rates.transpose());
	return {mean_length(covariance.topLeftCorner<2, 2>()), std::sqrt(2 / M_PI * covariance(2, 2))};
}

} // namespace bench
