// Where stereo pairs come from: two cameras, a folder of pictures, or a recording.
#pragma once

#include <cstdint>

#include "pongeye.h"

namespace track
{

struct StereoPair {
	int64_t utime; // middle of the exposure
	int64_t frame; // number of the trigger pulse where the trigger is heard, else counted: a number left out
		       // is a pair that never came
	pong_image left, right; // the source's own, until the next call of next()
	int64_t arrival_ns;     // when the later picture was here, by monotonic_ns()
	int32_t exposure_us[2] = {0, 0}; // by pong_side; 0: not known
};

// Pictures that never became a pair, by cause.
struct Dropped {
	int64_t unpaired = 0;   // no picture of the other camera belongs to it
	int64_t incomplete = 0; // packets were lost on the way
	int64_t late = 0;       // came while too many were still waiting
	int64_t repeated = 0;   // the same picture once more: the camera is frozen
	int64_t miscounted = 0; // of another pulse than its partner, by the cameras' counters

	int64_t total() const
	{
		return unpaired + incomplete + late + repeated + miscounted;
	}
};

// How a camera is. The numbers are those of PONGEYE_STATUS.
enum class CameraState {
	NONE = 0,      // the pictures come from elsewhere
	ABSENT = 1,    // it is waited for
	STREAMING = 2, // ready: pictures come, or will with the trigger
	QUIET = 3,     // it answers, but sends no picture while the trigger runs
	FROZEN = 4     // it sends the same picture again and again
};

struct CameraHealth {
	CameraState state = CameraState::NONE;
	int64_t losses = 0; // how often it was lost
};

// Pulses of the trigger, where it is heard, and those of which a camera's picture did not come.
struct Pulses {
	int64_t heard = 0;
	int64_t missed[2] = {0, 0}; // by pong_side
};

// ALONE: a picture without a partner, which was looked at before that was known; the other side's has no pixels. Or
// two that are no pair though their times say so.
enum class Next { PAIR, ALONE, NOTHING_YET, END };

class Source
{
public:
	virtual ~Source() = default;

	// The next pair; NOTHING_YET where it has not come. By one thread at a time.
	virtual Next next(StereoPair &pair) = 0;

	// Wait for the next pair, but not for long: then the caller does something else.
	virtual void wait()
	{
	}

	// Whether its pairs come when they come: then whoever looks at them is in a hurry.
	virtual bool is_live() const
	{
		return false;
	}

	virtual Dropped dropped() const = 0;

	virtual Pulses pulses() const
	{
		return {};
	}

	virtual CameraHealth health(pong_side) const
	{
		return {};
	}
};

} // namespace track
