// What is new in a picture, pixel by pixel.
#pragma once

#include <algorithm>
#include <cstdint>

#include "pongeye.h"

namespace pong
{

// The paper's frame difference, as far as the pixel became brighter: where the ball was in the earlier picture is no
// ball now.
inline uint8_t brighter(uint8_t now, uint8_t then)
{
	return now > then ? now - then : 0;
}

// How far the pixel lies outside of what two earlier pictures showed there, either way. A ball is seen before a
// brighter background too; where it was in one of the earlier pictures it lies inside.
inline uint8_t beyond_both(uint8_t now, uint8_t then, uint8_t before)
{
	const uint8_t low = std::min(then, before), high = std::max(then, before);
	return now > high ? now - high : now < low ? low - now : 0;
}

} // namespace pong
