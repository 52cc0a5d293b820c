// What the cameras have shown lately.
#pragma once

#include <algorithm>
#include <cstring>
#include <vector>

#include "pongeye.h"

namespace pong
{

// The last pictures of one camera, copied: the newest, and those that it is compared with.
class PictureRing
{
public:
	PictureRing(int width, int height, int length)
		: width_(width), height_(height),
		  pixels_(static_cast<size_t>(length), std::vector<uint8_t>(static_cast<size_t>(width) * height))
	{
	}

	size_t count() const
	{
		return count_;
	}

	// The one that was added `age` pictures before the newest, or the oldest.
	pong_image earlier(size_t age) const
	{
		const uint8_t *pixels = pixels_[(count_ - 1 - std::min(age, count_ - 1)) % pixels_.size()].data();
		return {pixels, width_, height_, width_};
	}

	void add(const pong_image &image)
	{
		uint8_t *copy = pixels_[count_++ % pixels_.size()].data();
		for (int v = 0; v < height_; v++)
			memcpy(copy + static_cast<size_t>(v) * width_, image.pixels + v * image.stride,
			       static_cast<size_t>(width_));
	}

private:
	int width_, height_;
	std::vector<std::vector<uint8_t>> pixels_;
	size_t count_ = 0;
};

} // namespace pong
