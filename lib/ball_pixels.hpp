// The pixels of a ball and of what is around it, as the photometric fit looks at them.
#pragma once

#include "locate.hpp"
#include "sphere.hpp"
#include "tangent.hpp"

namespace pong
{

const int pixels_max = 1536;
const int blocks_max = pixels_max / block;
const int sectors = 16;

// In blocks; what fills up the last one has no weight.
struct BallPixels {
	int count; // blocks
	SphereBlock blocks[blocks_max];
	float now[blocks_max][block];
	float weight[blocks_max][block];  // 1 / variance, as far as the sensor's noise goes
	uint8_t patch[blocks_max][block]; // which part of the ball a pixel belongs to
	bool cut;                         // the picture's border cuts the ball
};

const int patches = 2 * sectors; // the sectors of the inside, and those of the outline

// Where in the plane a ball is looked for.
struct BallPlace {
	Vector2 centre; // px
	double radius;  // px, in the plane
	Vector2 half;   // of its streak, px, in the plane
};

// All pixels about the outline of a ball that is small; of a large one's, and of the inside, a part is enough.
void choose_pixels(const LocateTask &task, const PlaneMap &map, const BallPlace &place, BallPixels *pixels);

} // namespace pong
