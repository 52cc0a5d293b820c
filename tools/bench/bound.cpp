#include "bound.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Dense>

namespace bench
{

namespace
{

// About a quarter of a pixel: less would drown in the rounding to grey levels, more would not be straight.
const double steps[3] = {0.0005, 0.0005, 0.004}; // m

// Of a grey level, as the sensor makes it: shot noise, read noise, rounding.
double noise_variance(const sim::SensorSettings &sensor, double level)
{
	const double levels_per_electron = 255 / sensor.full_well;
	return level * levels_per_electron + std::pow(sensor.read_noise * levels_per_electron, 2) + 1.0 / 12;
}

// Mean length of normal deviates of this covariance.
double mean_length(const Eigen::Matrix3d &covariance)
{
	const int draws = 2000;
	const Eigen::Matrix3d root = covariance.llt().matrixL();
	std::mt19937_64 random(1);
	std::normal_distribution<double> normal;
	double sum = 0;
	for (int i = 0; i < draws; i++) {
		const double x = normal(random), y = normal(random), z = normal(random);
		sum += (root * Eigen::Vector3d(x, y, z)).norm();
	}
	return sum / draws;
}

} // namespace

double position_bound(const sim::Scene &scene, Studio &still, const Eigen::Vector3d &position,
		      const Eigen::Vector3d &velocity)
{
	Shot middle, before[3], after[3];
	bool seen = still.take(position, velocity, &middle);
	for (int axis = 0; axis < 3 && seen; axis++) {
		const Eigen::Vector3d step = steps[axis] * Eigen::Vector3d::Unit(axis);
		seen = still.take(position - step, velocity, &before[axis]) &&
		       still.take(position + step, velocity, &after[axis]);
	}
	if (!seen)
		return std::numeric_limits<double>::quiet_NaN();
	Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
	for (size_t side = 0; side < 2; side++)
		for (size_t i = 0; i < middle.pixels[side][0].size(); i++) {
			Eigen::Vector3d slope;
			for (int axis = 0; axis < 3; axis++)
				slope[axis] = (after[axis].pixels[side][0][i] - before[axis].pixels[side][0][i]) /
					      (2 * steps[axis]);
			if (slope.isZero())
				continue;
			information += slope * slope.transpose() /
				       noise_variance(scene.picture.sensor, middle.pixels[side][0][i]);
		}
	return mean_length(information.inverse());
}

} // namespace bench
