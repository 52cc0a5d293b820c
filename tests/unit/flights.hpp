// Points of simulated flights: the truth is the simulator's, which shares no physics with the library.
#pragma once

#include <random>
#include <vector>

#include "pongeye.h"
#include "simulate/flight.hpp"

// A ball that comes to the robot over the net, with some spin, and bounces once.
inline sim::Ball usual_serve()
{
	sim::Ball ball;
	ball.position = {0.1, 0.3, 3.2};
	ball.velocity = {-0.2, 1.2, -7.5};
	ball.spin = {-60, 30, 20};
	return ball;
}

inline sim::Flight fly(const sim::Ball &ball, const sim::Coefficients &coefficients = {})
{
	return sim::Flight(coefficients, ball, {0, -0.4});
}

// The simulator's physics as a rig's; certain but for the spin.
inline pong_rig rig_of_simulator()
{
	pong_rig rig;
	pong_rig_defaults(&rig);
	const sim::Coefficients mean;
	rig.ball.drag = mean.drag;
	rig.ball.drag_by_spin = 0;
	rig.ball.magnus = mean.magnus;
	rig.ball.magnus_saturation = 0;
	rig.ball.restitution = mean.restitution;
	rig.ball.friction = mean.friction;
	rig.ball.grip = 0;
	rig.ball.drag_sigma = 0.005;
	rig.ball.magnus_sigma = 1e-8;
	rig.ball.restitution_sigma = rig.ball.friction_sigma = rig.ball.grip_sigma = rig.ball.kick = 1e-3;
	rig.table.height_sigma = 1e-3;
	return rig;
}

// Points of a flight from begin to end (s), with noise of a standard deviation (m) that they know.
inline std::vector<pong_point> points_of(const sim::Flight &flight, double begin, double end, double rate, double noise,
					 unsigned seed = 1)
{
	std::mt19937_64 random(seed);
	std::normal_distribution<double> normal;
	std::vector<pong_point> points;
	for (int i = 0; begin + i / rate < end; i++) {
		pong_point point = {};
		point.frame = i;
		point.utime = 1000000 + static_cast<int64_t>(1e6 * (begin + i / rate) + 0.5);
		const Eigen::Vector3d position = flight.at(static_cast<double>(point.utime - 1000000) * 1e-6).position;
		for (int axis = 0; axis < 3; axis++) {
			point.position[axis] = position[axis] + noise * normal(random);
			point.covariance[axis][axis] = noise * noise;
		}
		points.push_back(point);
	}
	return points;
}
