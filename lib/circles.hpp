// A ball before something else that moves: what is new there has no shape of a ball, but the picture itself shows the
// ball's outline.
#pragma once

#include "blob.hpp"

namespace pong
{

// Search the area, which lies inside of the patch, for circles of the sizes allowed around pixels that are lit. Puts
// them among found[count], as insert_detection does; returns the new count. `noise` is the standard deviation of a
// pixel, grey levels; `shown_needed` the part of the outline that must show.
int find_circles(const pong_image &image, const Patch &patch, const Area &area, const BallLimits &limits, double noise,
		 double shown_needed, pong_detection *found, int count, int capacity);

} // namespace pong
