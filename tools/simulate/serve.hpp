// How flights are drawn: plausible serves to the robot.
#pragma once

#include <array>
#include <random>

#include "flight.hpp"

namespace sim
{

using Random = std::mt19937_64;

// How flights are drawn.
struct FlightSettings {
	std::array<double, 2> speed = {7, 13};     // at the launch, m/s
	std::array<double, 2> aim = {-0.45, 0.45}; // x on the hit plane, m
	std::array<double, 2> bounce = {0.4, 1.1}; // z of the bounce, m
	double spin = 5;                           // at most, about any axis, revolutions/s
	double gap = 0.4;                          // without a ball between flights, s
	// Drawn for each flight: mean and standard deviation.
	std::array<double, 2> drag = {0.47, 0.015};
	std::array<double, 2> magnus = {4.65e-6, 0.1e-6}; // kg
	std::array<double, 2> restitution = {0.93, 0.01};
	std::array<double, 2> friction = {0.25, 0.02};
};

// A flight that comes over the net, bounces once on the robot's side, and reaches the hit plane at a height at which
// it can be hit. Throws pong::Failure where the settings allow none.
Flight draw_flight(const FlightSettings &settings, const Planes &planes, Random &random);

} // namespace sim
