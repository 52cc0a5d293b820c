// How much of a ball's outline a picture shows by itself, whatever was there before.
#pragma once

#include "pongeye.h"

namespace pong
{

// The step in grey level from just outside to just inside of a circle, all round it.
struct Outline {
	double shown; // the part of the circle where there is a step that noise does not make
	double step;  // its mean magnitude, grey levels
};

// `noise` is the standard deviation of a pixel, grey levels. What the picture's border cuts off has no say; where it
// cuts off more than half, nothing is shown.
Outline measure_outline(const pong_image &image, double u, double v, double radius, double noise);

} // namespace pong
