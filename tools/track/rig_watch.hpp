// Whether the rig still is what rig.toml says. A camera that was knocked shows the balls beside their epipolar lines,
// all to the same side: the signed distances of the tracker's own balls tell it without any board.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>

#include "pongeye.h"

namespace track
{

// How far the right picture lies below the epipolar lines of the left one. NaN until enough flights were seen.
struct RigOffset {
	double mean = NAN, sigma = NAN; // px; sigma: the standard deviation of that mean
	bool knocked = false;           // it is off by more than chance and more than is harmless
};

// The centres of a flight are lit alike and err alike: a flight counts as one sample, the median of its balls. The mean
// is the median of the last flights, and its uncertainty follows from how they scatter, so that one false flight does
// no harm. A turn of a camera about the axis across moves the mean most; one about its upright axis moves depth only,
// which epipolar lines do not show.
class RigWatch
{
public:
	void see(const pong_ball &ball);

	const RigOffset &offset() const
	{
		return offset_;
	}

	// What to do about it, once: empty until the rig is found knocked, and after it was said.
	std::string warning();

private:
	static constexpr size_t BALLS = 64, FLIGHTS = 16;

	void close_flight();
	void judge();

	int32_t track_ = 0;
	std::array<double, BALLS> balls_ = {}; // epipolar distances of the running flight, px
	size_t ball_count_ = 0;
	std::array<double, FLIGHTS> flights_ = {}; // medians of the last flights, px
	size_t flight_count_ = 0;                  // since the start
	RigOffset offset_;
	bool said_ = false;
};

} // namespace track
