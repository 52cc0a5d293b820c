// The pixels of a detected ball.
#pragma once

#include <algorithm>
#include <cmath>

#include "pongeye.h"

namespace pong
{

// Call visit(u, v) for every pixel of the picture whose centre lies within `radius` of the detection.
template<class Visit>
void for_each_pixel(const pong_image &image, const pong_detection &detection, double radius, Visit visit)
{
	const int u_begin = std::max(0, static_cast<int>(std::ceil(detection.u - radius)));
	const int u_end = std::min(image.width - 1, static_cast<int>(std::floor(detection.u + radius)));
	const int v_begin = std::max(0, static_cast<int>(std::ceil(detection.v - radius)));
	const int v_end = std::min(image.height - 1, static_cast<int>(std::floor(detection.v + radius)));
	for (int v = v_begin; v <= v_end; v++)
		for (int u = u_begin; u <= u_end; u++)
			if (std::hypot(u - detection.u, v - detection.v) <= radius)
				visit(u, v);
}

} // namespace pong
