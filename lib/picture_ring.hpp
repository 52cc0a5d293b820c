// What the cameras have shown lately.
#pragma once

#include <algorithm>
#include <cstring>
#include <vector>

#include "pongeye.h"

namespace pong
{

// The last pictures of one camera: the newest, and those that it is compared with. The newest is the caller's until it
// is kept, for to copy it takes time that whoever waits for the ball does not have.
class PictureRing
{
public:
	static const int margin = 4; // px: a kept picture may be looked at as if it had moved so far, its border too

	PictureRing(int width, int height, int length)
		: width_(width), height_(height), before_(static_cast<size_t>(margin) * width + margin),
		  pixels_(static_cast<size_t>(length),
			  std::vector<uint8_t>(static_cast<size_t>(width) * height + 2 * before_))
	{
	}

	size_t count() const
	{
		return kept_ + (has_newest() ? 1 : 0);
	}

	// The one that was added `age` pictures before the newest, or the oldest.
	pong_image earlier(size_t age) const
	{
		const size_t number = count() - 1 - std::min(age, count() - 1);
		return number == kept_ ? newest_ : pong_image{pixels_of(number), width_, height_, width_};
	}

	// An earlier one that was not kept is forgotten.
	void add(const pong_image &image)
	{
		newest_ = image;
	}

	bool has_newest() const // which is not kept yet
	{
		return newest_.pixels;
	}

	// Copy the newest. False where that has been done.
	bool keep()
	{
		if (!has_newest())
			return false;
		uint8_t *copy = pixels_of(kept_++);
		for (int v = 0; v < height_; v++)
			memcpy(copy + static_cast<size_t>(v) * width_, newest_.pixels + v * newest_.stride,
			       static_cast<size_t>(width_));
		newest_ = {};
		return true;
	}

	// As if the newest had never been added, unless it was kept.
	void forget()
	{
		newest_ = {};
	}

private:
	const uint8_t *pixels_of(size_t number) const
	{
		return pixels_[number % pixels_.size()].data() + before_;
	}
	uint8_t *pixels_of(size_t number)
	{
		return pixels_[number % pixels_.size()].data() + before_;
	}

	int width_, height_;
	size_t before_; // pixels, and as many behind
	std::vector<std::vector<uint8_t>> pixels_;
	size_t kept_ = 0;
	pong_image newest_ = {}; // not kept yet
};

} // namespace pong
