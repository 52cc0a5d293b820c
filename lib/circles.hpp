// A ball before something else that moves: what is new there has no shape of a ball, but the picture itself shows the
// ball's outline.
#pragma once

#include "blob.hpp"

namespace pong
{

// What is searched for.
struct CircleSought {
	BallLimits limits;
	double noise;              // standard deviation of a pixel, grey levels
	const pong_window *window; // where a ball is expected: less of it need show there; or null
};

// Search the area, which lies inside of the patch, for circles of the sizes allowed around pixels that are lit. Puts
// them among found[count], as insert_detection does; returns the new count.
int find_circles(const pong_image &image, const Patch &patch, const Area &area, const CircleSought &sought,
		 pong_detection *found, int count, int capacity);

// Move a place to where around it, at its size, the outline is strongest. Returns whether enough of it shows there for
// a ball that something else says is there.
bool find_circle_near(const pong_image &image, double noise, pong_detection *place);

} // namespace pong
