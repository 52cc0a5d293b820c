// Whether two pictures that their times make a pair were exposed by the same pulse, by their cameras' counters.
//
// The counters begin when they like: what they differ by is learnt from the first pair. A camera that misses an edge
// lags behind by one more from then on, so another difference is believed when it has stood for a few pairs.
#pragma once

#include <cstdint>
#include <optional>

namespace track
{

class PulseCheck
{
public:
	// What each camera has counted; none where it does not count.
	bool agrees(const std::optional<int64_t> &left, const std::optional<int64_t> &right)
	{
		if (!left || !right)
			return true;
		const int64_t difference = *right - *left;
		if (difference != latest_)
			times_ = 0;
		latest_ = difference;
		times_++;
		if (!usual_ || times_ >= BELIEVED)
			usual_ = difference;
		return difference == usual_;
	}

private:
	static constexpr int BELIEVED = 4; // pairs

	std::optional<int64_t> usual_, latest_;
	int times_ = 0; // that the latest one came
};

} // namespace track
