// The time of another clock's ticks on ours, from timed requests.
#pragma once

#include <cstdint>
#include <deque>

namespace pong
{

// A request leaves at `sent` and is answered at `received`; in between the other side has read its own clock: `tick`.
// Nobody knows when in between, so half of the round trip is the most that the middle can be wrong by, and only the
// fastest round trips are believed. Through these goes the line
//
//     host = offset + slope * tick
//
// by least squares, over the last 10 s or so, for crystals drift with their temperature.
class ClockFit
{
public:
	explicit ClockFit(double ticks_per_second);

	// Host times in ns of the monotonic clock. Ticks may wrap; samples come at least every 2^31 ticks.
	void add(int64_t sent, int64_t received, uint32_t tick);

	// Enough fast round trips over enough time.
	bool settled() const;

	// Host time of a tick within 2^31 ticks of the last sample, ns.
	int64_t host_ns(uint32_t tick) const;

	// Root mean square distance of the believed samples from the line, s.
	double residual() const;

	// The fastest round trip, s: its half bounds what no fit can see, that the way there and back differ.
	double fastest() const;

private:
	struct Sample {
		int64_t middle;     // host, ns
		int64_t round_trip; // ns
		int64_t tick;       // without wraps
	};
	int64_t unwrap(uint32_t tick) const;
	void fit();

	double nominal_; // ns a tick
	std::deque<Sample> samples_;
	// The line: middle - origin_.middle = offset_ + slope_ * (tick - origin_.tick), ns.
	Sample origin_ = {};
	double offset_ = 0, slope_, residual_ = 0, fastest_ = 0;
	bool settled_ = false;
};

} // namespace pong
