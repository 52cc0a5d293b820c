// Tells a camera that sends the same picture again and again from one that looks at something that does not move: the
// noise of a sensor never comes twice.
#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include "pongeye.h"

namespace track
{

class Still
{
public:
	Still(int width, int height)
		: width_(static_cast<size_t>(width)), rows_(static_cast<size_t>(height / ROWS)), before_(width_ * rows_)
	{
	}

	// Whether this picture is the one before, to the last bit. Every fourth row is looked at, which no ball that is
	// large enough to be found lies between; pictures that differ do so in the first few pixels.
	bool is_repeated(const pong_image &image)
	{
		bool same = has_before_;
		for (size_t row = 0; row < rows_; row++) {
			const uint8_t *now = image.pixels + static_cast<int>(row) * ROWS * image.stride;
			uint8_t *before = &before_[row * width_];
			same = same && memcmp(now, before, width_) == 0;
			if (!same)
				memcpy(before, now, width_);
		}
		has_before_ = true;
		return same;
	}

private:
	static constexpr int ROWS = 4;

	size_t width_, rows_;
	std::vector<uint8_t> before_;
	bool has_before_ = false;
};

} // namespace track
