// What two pictures say of themselves: how much they differ where nothing moved.
#pragma once

#include "cells.hpp"

namespace pong
{

// The sums of cells here and there in a picture, and of the same cells in an earlier one.
struct CellSamples {
	static const int capacity = 256;
	int count = 0;
	uint16_t now[capacity + cells_beside], then[capacity + cells_beside];
};

// By how much what rests became brighter, in 1 / gain_one. More than half of the samples must be of what rests.
int32_t measure_gain(const CellSamples &samples);

// The standard deviation of the difference of two cells' means, grey levels; 0 without samples. The third of the
// samples that differ least tell it, so that what moves has no say.
double measure_noise(const CellSamples &samples, int32_t gain);

} // namespace pong
