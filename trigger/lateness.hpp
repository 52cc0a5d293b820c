// How late a program's edges were: what a userspace port can know of its own quality.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace pong
{

class Lateness
{
public:
	// A pulse with an edge later than this counts as late: more than a PREEMPT_RT kernel is expected to need, s.
	static constexpr double LATE = 200e-6;

	void add(double seconds);
	int64_t late() const;
	double worst() const;

	// The histogram, a line a bin.
	std::string text() const;

private:
	// Upper ends of the bins in us; the last bin has none.
	static constexpr std::array<int, 10> ENDS = {10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000};
	std::array<int64_t, ENDS.size() + 1> bins_ = {};
	int64_t late_ = 0;
	double worst_ = 0;
};

} // namespace pong
