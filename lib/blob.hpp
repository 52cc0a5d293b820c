// What is lit in a patch, measured: is it a ball?
#pragma once

#include "patch.hpp"

namespace pong
{

// What a ball may look like.
struct BallLimits {
	double size_min, size_max; // px
	double contrast;           // least, grey levels
	double noise;              // standard deviation of a patch's level where nothing is new, grey levels
};

// Measure what is lit inside of `area`, expected to be about `contrast` (grey levels) brighter or darker than before.
// Returns whether it is an ellipse, not longer than a ball's streak, of the sizes and contrast allowed, alone in its
// surroundings, which shows the five points.
bool measure_blob(const Patch &patch, const Area &area, double contrast, const BallLimits &limits,
		  pong_detection *ball);

// The level, in grey levels, from which on a pixel belongs to a ball of that contrast.
double lit_level(double contrast, const BallLimits &limits);

} // namespace pong
