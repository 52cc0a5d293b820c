// The paper's 66 launches, simulated: true flights, what two cameras measure of them, and how well a flight could be
// predicted at all. The flights are the simulator's: nothing here is the library's.
#pragma once

#include <vector>

#include "pongeye.h"
#include "simulate/camera.hpp"
#include "simulate/serve.hpp"

namespace bench
{

// How much is known of a flight before it begins: standard deviations.
struct Spread {
	double spin;                                // of a component, rad/s
	double drag, magnus, restitution, friction; // as in sim::Coefficients
};

struct LaunchSettings {
	double spin = 5;    // at most, about any axis, revolutions/s
	double noise = 0.1; // of a centre, per axis, px
	double rate = 110;  // frames/s
	unsigned seed = 1;
};

// A true flight and when both cameras see it whole.
struct Launch {
	sim::Coefficients coefficients;
	sim::Flight flight;
	std::vector<double> times; // of the pairs, s from the launch
};

// What the launches of these settings are drawn with.
Spread spread_of(const LaunchSettings &settings);

// 11 directions x 3 speeds x 2.
std::vector<Launch> draw_launches(const sim::Rig &rig, const LaunchSettings &settings);

// The pairs as points, with noise on both centres.
std::vector<pong_point> measure(const sim::Rig &sim_rig, const pong_rig &rig, const Launch &launch,
				const LaunchSettings &settings, sim::Random &random);

// The Cramer-Rao bound of a prediction from all pairs until `latest`, under the spread as prior: mean distance on the
// hit plane (m) and mean absolute error of the time (s) that no unbiased method beats.
struct Bound {
	double distance, time;
};
Bound prediction_bound(const sim::Rig &rig, const Launch &launch, double latest, const LaunchSettings &settings);

} // namespace bench
