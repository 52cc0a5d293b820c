// The coefficients of air, ball and table from recorded flights.
#pragma once

#include <string>
#include <vector>

#include "points.hpp"
#include "pongeye.h"

namespace predict
{

// A coefficient over many flights.
struct Fitted {
	const char *section, *key; // in rig.toml
	double mean, sigma;        // what holds for all flights, and how they differ
	double uncertainty;        // standard deviation of the mean
};

struct Fit {
	std::vector<Fitted> coefficients;
	double spin_sigma[3]; // rad/s
	size_t flights;
};

// Fit them, from the rig's values on, by expectation maximisation: every flight's most probable coefficients under the
// present mean and spread, then the mean and spread of those. What the rig believed before counts as a few flights.
// The rig gets the result.
Fit fit(const std::vector<RecordedFlight> &flights, const pong_settings &settings, double noise, pong_rig &rig);

// The result as text: the [ball] and [table] of a rig.toml.
std::string fit_text(const Fit &fit, const pong_table &table);

} // namespace predict
