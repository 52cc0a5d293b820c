// Somebody who looks at each camera's picture as it comes, in that camera's own thread.
#pragma once

#include <cstdint>

#include "pongeye.h"

namespace track
{

class Onlooker
{
public:
	virtual ~Onlooker() = default;

	// In the camera's thread, before anybody else gets the picture: whether it is to be looked at now. may_begin:
	// no earlier picture waits to be looked at, so that this one may be the first of its pair.
	virtual bool claim(pong_side side, int64_t utime, const pong_image &image, bool may_begin) = 0;

	// In the camera's thread: look at the picture that was just claimed. Whether its pair has been looked at now.
	virtual bool look(pong_side side, const pong_image &image) = 0;

	// Whether this picture is claimed, and its pair has not been seen to its end.
	virtual bool holds(pong_side side, const pong_image &image) = 0;
};

} // namespace track
