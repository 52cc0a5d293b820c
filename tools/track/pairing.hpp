// Which picture of the left camera and which of the right one were exposed by the same trigger pulse.
//
// Pictures are paired by time. Frame counters cannot do it: a camera that misses a trigger pulse skips no number, and
// from then on equal numbers belong to different pulses.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "fifo.hpp"
#include "pongeye.h"
#include "pulse_check.hpp"

namespace track
{

// Part of a period. Pictures of one pulse lie far closer together, those of two pulses a whole period apart. Half a
// period is the limit; a third leaves room for jitter, and holds even where a learnt period is twice the true one,
// because every second pulse was missed.
constexpr double PAIRING_TOLERANCE = 1.0 / 3;

struct Picture {
	int64_t utime;                                // middle of the exposure
	int64_t arrival_ns;                           // monotonic_ns()
	void *buffer;                                 // whatever holds the pixels
	std::optional<int64_t> pulses = std::nullopt; // that its camera has counted, where it does
};

struct PicturePair {
	int64_t utime;      // the mean of both
	int64_t frame;      // trigger pulses since the first pair, which has 0
	Picture picture[2]; // by pong_side
	bool miscounted;    // of two pulses, by the cameras' counters: then it has no frame number
};

class Pairing
{
public:
	// What to do with a picture that has no partner.
	using Release = std::function<void(pong_side side, const Picture &picture)>;

	// rate: trigger pulses a second; 0: learn it from the first pictures, which are released and not
	// counted: they would come late.
	Pairing(double rate, Release release);

	// Add a picture. Those of one side come in the order of time; the two sides may run ahead of each other.
	void push(pong_side side, const Picture &picture);

	// The next pair, if there is one.
	bool pop(PicturePair &pair);

	// Release all that still wait.
	void clear();

	// Pictures without a partner so far.
	int64_t unpaired() const
	{
		return unpaired_;
	}

	// Pictures of the miscounted pairs so far.
	int64_t miscounted() const
	{
		return miscounted_;
	}

private:
	static constexpr size_t WAITING = 16;
	static constexpr size_t INTERVALS = 8;

	void learn_period(int64_t interval);
	void dismiss(pong_side side, const Picture &picture);
	int64_t number_frame(int64_t utime);

	Release release_;
	Fifo<Picture, WAITING> waiting_[2];
	int64_t last_utime_[2];
	double period_;    // microseconds; 0: not known yet
	double tolerance_; // microseconds
	int64_t intervals_[INTERVALS];
	size_t interval_count_ = 0;
	bool paired_ = false;
	int64_t pair_utime_ = 0, frame_ = 0;
	PulseCheck check_;
	int64_t unpaired_ = 0, miscounted_ = 0;
};

} // namespace track
