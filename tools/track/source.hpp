// Where stereo pairs come from: a folder of pictures, or two cameras.
#pragma once

#include <cstdint>

#include "pongeye.h"

namespace track
{

struct StereoPair {
	int64_t utime;          // middle of the exposure
	int64_t frame;          // counts trigger pulses: a number left out is a pair that never came
	pong_image left, right; // the source's own, until the next call of next()
	int64_t arrival_ns;     // when the later picture was here, by monotonic_ns()
};

// Pictures that never became a pair, by cause.
struct Dropped {
	int64_t unpaired = 0;   // no picture of the other camera belongs to it
	int64_t incomplete = 0; // packets were lost on the way
	int64_t late = 0;       // came while too many were still waiting

	int64_t total() const
	{
		return unpaired + incomplete + late;
	}
};

enum class Next { PAIR, NOTHING_YET, END };

class Source
{
public:
	virtual ~Source() = default;

	// Wait for the next pair, but not for ever: where none comes, NOTHING_YET lets the caller do something else.
	virtual Next next(StereoPair &pair) = 0;

	virtual Dropped dropped() const = 0;
};

} // namespace track
