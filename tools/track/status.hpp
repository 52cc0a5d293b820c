// How the tracker is doing: counts since the start, and rates and latency over the last second.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "latency.hpp"
#include "pongeye.h"
#include "rig_watch.hpp"
#include "source.hpp"

namespace track
{

// What PONGEYE_STATUS says; NaN where a second had nothing to measure.
struct StatusReport {
	int64_t pairs = 0, dropped = 0;
	int64_t missed_left = 0, missed_right = 0;                         // trigger pulses
	Dropped causes;                                                    // of what was dropped
	std::array<CameraHealth, 2> cameras;                               // by pong_side
	std::array<int64_t, PONG_OUTCOMES> outcomes = {};                  // pairs by pong_outcome
	double pair_rate = NAN, ball_rate = NAN;                           // per second
	double latency_median = NAN, latency_p99 = NAN, latency_max = NAN; // s
	double epipolar_mean = NAN, epipolar_rms = NAN;                    // px
	RigOffset rig;
};

class Status
{
public:
	explicit Status(int64_t now_ns);

	// One pair was looked at. latency_s: from its arrival until its ball was published.
	void count(const pong_sight &sight, double latency_s);

	bool second_over(int64_t now_ns) const;

	// Make the report of the second that is over, and begin the next.
	void close_second(int64_t now_ns, const Source &source);

	// Of the last whole second.
	const StatusReport &report() const
	{
		return report_;
	}

	RigWatch &rig_watch()
	{
		return rig_watch_;
	}

	// The whole run in one line.
	std::string summary(const Source &source) const;

private:
	static constexpr size_t EPIPOLAR_BALLS = 128;

	void measure_epipolar();

	int64_t begin_ns_; // of the running second
	int64_t pairs_ = 0, pairs_before_ = 0, balls_before_ = 0;
	std::array<int64_t, PONG_OUTCOMES> outcomes_ = {};
	Latencies second_;
	Latencies run_[2]; // of the run: where the ball was searched for everywhere, and where it was expected
	std::array<double, EPIPOLAR_BALLS> epipolar_ = {}; // of the last balls, px
	size_t epipolar_count_ = 0;
	RigWatch rig_watch_;
	StatusReport report_;
};

} // namespace track
