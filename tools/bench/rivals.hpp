<<<<<<< HEAD
// Other people's ways to predict a flight, to be measured beside ours: an extended Kalman filter with spin, and least
// squares with drag only. Both fly the simulator's own physics with its mean coefficients, so neither suffers from a
// wrong model of the bounce but for what it cannot know.
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Dense>

#include "pongeye.h"
#include "simulate/flight.hpp"
=======
// OpenCV's ways to find a ball and its centre.
#pragma once

#include <opencv2/core.hpp>

#include "pongeye.h"
>>>>>>> prophet

namespace bench
{

<<<<<<< HEAD
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
=======
enum class Rival { moments, enclosing_circle, ellipse, hough };

const char *rival_name(Rival rival);

// The largest contour of |current - earlier| > threshold inside of `where`, and its centre. False where there is none.
bool find_by_contour(const pong_pictures &pictures, const cv::Rect &where, Rival rival, double uv[2]);

// cv::triangulatePoints.
void triangulate_by_opencv(const pong_rig &rig, const double left[2], const double right[2], double position[3]);
>>>>>>> prophet

} // namespace bench
