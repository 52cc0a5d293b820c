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
	bool is_repeated(const pong_image &image) const
	{
		bool same = has_before_;
		for (size_t row = 0; same && row < rows_; row++)
			same = memcmp(row_of(image, row), &before_[row * width_], width_) == 0;
		return same;
	}

	// This picture is the one before, from now on.
	void remember(const pong_image &image)
	{
		for (size_t row = 0; row < rows_; row++)
			memcpy(&before_[row * width_], row_of(image, row), width_);
		has_before_ = true;
	}

private:
	static constexpr int ROWS = 4;

	static const uint8_t *row_of(const pong_image &image, size_t row)
	{
		return image.pixels + static_cast<int>(row) * ROWS * image.stride;
	}

	size_t width_, rows_;
	std::vector<uint8_t> before_;
	bool has_before_ = false;
};

} // namespace track
