// One flight: a ball's path from the launch over the table and past the robot.
#pragma once

#include <optional>
#include <vector>

#include "ball.hpp"

namespace sim
{

// Where a ball crosses the robot's hit plane.
struct Hit {
	double time; // s from the launch
	Eigen::Vector3d position;
};

// The planes that end a flight, m.
struct Planes {
	double hit_z = 0;    // the robot hits here
	double end_z = -0.4; // the flight ends here, behind the cameras' backs, or on the floor
};

class Flight
{
public:
	// Fly from the launch on, bouncing on the table.
	Flight(const Coefficients &coefficients, const Ball &launch, const Planes &planes);

	// The ball `time` seconds after the launch; before it, and after the end, it rests where it was.
	Ball at(double time) const;

	const std::optional<Hit> &hit() const;
	// Bounces on the table before the hit.
	const std::vector<Ball> &bounces() const;
	// Height of the ball's centre over the net, m; NaN where it never passes there.
	double over_net() const;
	double duration() const;

private:
	struct Sample {
		double time;
		Ball ball;
	};
	void add(double time, const Ball &ball);
	Sample advance(const Coefficients &coefficients, const Sample &now);
	void watch(const Coefficients &coefficients, const Sample &from, const Sample &to, double hit_z);

	std::vector<Sample> samples_; // close enough for cubics between them; two at a bounce
	std::vector<Ball> bounces_;
	std::optional<Hit> hit_;
	double over_net_;
};

} // namespace sim
