#include "outline.hpp"

#include <algorithm>
#include <cmath>

namespace pong
{

namespace
{

const int sectors = 16;
const double gap = 1;            // between the outline and what is compared, px: the lens blurs,
const double depth = 2;          // and how deep that is, px
const double step_noise = 3;     // a step of so many standard deviations of its noise is one,
const double step_part = 0.2;    // if it is this part of the mean step, too
const double inside_least = 0.3; // of the radius, is not looked at: the middle of a small ball

// Sums of the pixels on one side of the outline, by direction.
struct Ring {
	double sum[sectors] = {}, count[sectors] = {};

	void add(int sector, double level)
	{
		sum[sector] += level;
		count[sector]++;
	}
};

// 16 of a kind without a call of atan2: by signs, by which coordinate is greater, and by whether the angle is over
// half of the eighth.
int sector_of(double x, double y)
{
	const double a = std::abs(x), b = std::abs(y);
	const double tangent_of_half = 0.41421356;
	const double less = std::min(a, b), more = std::max(a, b);
	return 8 * (x < 0) + 4 * (y < 0) + 2 * (a < b) + (less > tangent_of_half * more);
}

} // namespace

Outline measure_outline(const pong_image &image, double u, double v, double radius, double noise)
{
	const double out = radius + gap + depth;
	const double edge = std::max(radius - gap, 0.6 * radius), in = std::max(edge - depth, inside_least * radius);
	const int u_begin = std::max(0, static_cast<int>(std::ceil(u - out)));
	const int u_end = std::min(image.width - 1, static_cast<int>(std::floor(u + out)));
	const int v_begin = std::max(0, static_cast<int>(std::ceil(v - out)));
	const int v_end = std::min(image.height - 1, static_cast<int>(std::floor(v + out)));
	Ring inside, outside;
	for (int row = v_begin; row <= v_end; row++) {
		const uint8_t *pixels = image.pixels + row * image.stride;
		for (int column = u_begin; column <= u_end; column++) {
			const double x = column - u, y = row - v, distance2 = x * x + y * y;
			if (distance2 > out * out || distance2 < in * in)
				continue;
			if (distance2 < edge * edge)
				inside.add(sector_of(x, y), pixels[column]);
			else if (distance2 > (radius + gap) * (radius + gap))
				outside.add(sector_of(x, y), pixels[column]);
		}
	}
	double steps[sectors], sum = 0;
	int measured = 0;
	for (int i = 0; i < sectors; i++) {
		steps[i] = inside.count[i] > 0 && outside.count[i] > 0
				   ? std::abs(inside.sum[i] / inside.count[i] - outside.sum[i] / outside.count[i])
				   : 0;
		sum += steps[i];
		measured += inside.count[i] > 0 && outside.count[i] > 0;
	}
	const double mean = sum / std::max(measured, 1);
	int shown = 0;
	for (int i = 0; i < sectors; i++) {
		if (!(inside.count[i] > 0 && outside.count[i] > 0))
			continue;
		const double of_noise = step_noise * noise * std::sqrt(1 / inside.count[i] + 1 / outside.count[i]);
		shown += steps[i] > std::max(of_noise, step_part * mean);
	}
	return {measured < sectors / 2 ? 0 : static_cast<double>(shown) / measured, mean};
}

} // namespace pong
