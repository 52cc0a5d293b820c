// The search region as the detector reads it.
#pragma once

#include <vector>

#include "pongeye.h"

struct pong_region {
	int width, height;
	std::vector<pong_region_row> rows;
};

namespace pong
{

// Whether a ball can be there: over the table, or no farther beside and behind it than the settings allow. Always,
// where there is no table. Balls that have passed the hit plane are balls all the same.
bool in_flight_space(const pong_rig &rig, const pong_settings &settings, const double position[3]);

} // namespace pong
