// What has just come into a picture. People and their shadows move by a few pixels from one picture to the next: what
// they show now, the picture before showed close by. A ball that comes into view was not there.
#pragma once

#include "cells.hpp"
#include "detector.hpp"

namespace pong
{

// How much brighter the picture is than the one before, in 1 / gain_one: a lamp flickers.
int32_t gain_between(const pong_image &now, const pong_image &previous);

// Whether a cell of the picture is: its mean difference from all places near it in the picture before is above `level`,
// grey levels.
bool is_fresh_cell(const pong_image &now, const pong_image &previous, int32_t gain, int column, int row, double level);

// How much the inside of a circle differs from what is most alike in the picture before, as far from it as people move:
// mean over the pixels, grey levels.
double freshness(const pong_image &now, const pong_image &previous, int32_t gain, double u, double v, double radius);

// An earlier picture, moved as what an area shows has moved since: in two ways, for an arm and what is behind it. Only
// in the area may they be looked at.
struct Moved {
	pong_image image[2];
};
Moved follow_motion(const pong_image &now, const pong_image &earlier, const Area &area);

} // namespace pong
