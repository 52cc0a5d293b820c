// Pictures in cells of 4 x 4 pixels: sums that drown the noise, and a sixteenth of the places to look at.
#pragma once

#include <cstdint>

#include "pongeye.h"

namespace pong
{

const int cell_size = 4; // px
const int cell_pixels = cell_size * cell_size;

// The sums of `count` cells beside each other; `top` is the first one's upper left pixel.
void sum_cells(const uint8_t *top, ptrdiff_t stride, int count, uint32_t *sums);

// now - gain * then of `count` cells, with gain in 1 / gain_one. Returns whether any lies outside of +- threshold.
const int32_t gain_one = 4096;
bool subtract_cells(const uint32_t *now, const uint32_t *then, int32_t gain, int32_t threshold, int count,
		    int32_t *difference);

} // namespace pong
