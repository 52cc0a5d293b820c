// Percentiles of many durations in little, fixed memory: counts in bins that grow by 1 %.
#pragma once

#include <array>
#include <cstdint>

namespace track
{

class Latencies
{
public:
	void add(double seconds);
	void clear();

	// The duration (s) that the given part (0 .. 1) of all stays at or below, true to 1 %; NaN of none.
	double percentile(double part) const;

	// The longest, exactly; NaN of none.
	double max() const;

private:
	static constexpr double SHORTEST = 1e-6; // s
	static constexpr double GROWTH = 1.01;
	static constexpr int BINS = 1852; // up to 100 s

	std::array<int64_t, BINS> counts_ = {};
	int64_t total_ = 0;
	double max_ = 0;
};

} // namespace track
