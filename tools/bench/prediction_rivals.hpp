// Other people's ways to predict a flight, to be measured beside ours: an extended Kalman filter with spin, and least
// squares with drag only. Both fly the simulator's own physics with its mean coefficients, so neither suffers from a
// wrong model of the bounce but for what it cannot know.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Dense>

#include "pongeye.h"
#include "simulate/flight.hpp"

namespace bench
{

// What a method says of the hit: position (m), and time (s) after the first point's utime.
struct Guess {
	Eigen::Vector3d position;
	double time;
};

// Nine states: position, velocity, spin. The spin's standard deviation per component (rad/s) is its prior.
class KalmanFilter
{
public:
	explicit KalmanFilter(double spin_sigma);
	void add(const pong_point &point);
	std::optional<Guess> guess() const;

private:
	using State = Eigen::Matrix<double, 9, 1>;
	using Covariance = Eigen::Matrix<double, 9, 9>;
	void begin(const pong_point &point);
	void go_on(double duration);

	double spin_sigma_;
	State state_;
	Covariance covariance_;
	int count_ = 0;
	int64_t first_utime_ = 0, utime_ = 0;
};

// Position and velocity through drag and gravity, fitted to all points of the leg since the last bounce.
std::optional<Guess> least_squares(const std::vector<pong_point> &points);

} // namespace bench
