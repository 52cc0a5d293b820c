// Pictures in cells of 4 x 4 pixels: sums that drown the noise, and a sixteenth of the places to look at.
#pragma once

#include <cstdint>

#include "pongeye.h"

namespace pong
{

const int cell_size = 4; // px
const int cell_pixels = cell_size * cell_size;

// The sums of `count` cells beside each other; `top` is the first one's upper left pixel.
void sum_cells(const uint8_t *top, ptrdiff_t stride, int count, uint16_t *sums);

// The same, for processors without the instructions that the former uses where it can.
void sum_cells_plainly(const uint8_t *top, ptrdiff_t stride, int count, uint16_t *sums);

// Grey levels times a gain, in 1 / gain_one, at most 4.
const int32_t gain_one = 4096;
void scale_cells(const uint16_t *sums, int count, int32_t gain, uint16_t *scaled);

// Of sums beside each other, so many more are read than asked for, whatever they are.
const int cells_beside = 15;

// The greatest magnitude of now - then of `count` cells.
int greatest_difference(const uint16_t *now, const uint16_t *then, int count);

// How far each of `count` cells lies outside of what two earlier pictures show, brighter or darker. There must be room
// for cells_beside more.
void measure_outside(const uint16_t *now, const uint16_t *then, const uint16_t *before, int count, int16_t *outside);

} // namespace pong
