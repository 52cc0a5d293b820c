// A part of a picture close up: how far its pixels lie outside of what two earlier pictures showed there.
#pragma once

#include <vector>

#include "cells.hpp"
#include "detector.hpp"

namespace pong
{

// By how much a lamp that flickers made the current picture brighter than each earlier one, in 1 / gain_one.
struct Gains {
	int32_t of[2];
};

class Patch
{
public:
	Patch(int width, int height);

	// Look at the area, which must be inside of the picture.
	void fill(const pong_pictures &pictures, const Gains &gains, const Area &area);

	const Area &area() const
	{
		return area_;
	}

	// The mean over 3 x 3 pixels of how far they lie outside, in 1 / patch_one grey levels; 0 out of the area.
	int at(int u, int v) const
	{
		return area_.contains(u, v) ? *pixel(u, v) : 0;
	}

	// The same, from the pixel (u, v) of the area onwards; the next row of it lies `stride` farther.
	const int16_t *pixel(int u, int v) const
	{
		return level_.data() + (v - area_.v_begin) * stride_ + (u - area_.u_begin);
	}

	// Not much more than the area is wide, so that the cache holds it.
	ptrdiff_t stride() const
	{
		return stride_;
	}

private:
	Area area_ = {0, 0, 0, 0};
	ptrdiff_t stride_ = 0;
	std::vector<int16_t> level_; // by pixel, summed over 3 x 3
};

const int patch_one = 9; // a grey level

} // namespace pong
