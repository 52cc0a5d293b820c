#include "pairing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

namespace track
{

Pairing::Pairing(double rate, Release release)
	: release_(std::move(release)), last_utime_{INT64_MIN, INT64_MIN}, period_(rate > 0 ? 1e6 / rate : 0),
	  tolerance_(PAIRING_TOLERANCE * period_)
{
}

void Pairing::push(pong_side side, const Picture &picture)
{
	if (picture.utime <= last_utime_[side]) {
		dismiss(side, picture);
		return;
	}
	const int64_t before = last_utime_[side];
	last_utime_[side] = picture.utime;
	if (period_ == 0) {
		if (before != INT64_MIN)
			learn_period(picture.utime - before);
		release_(side, picture);
		return;
	}
	if (waiting_[side].full())
		dismiss(side, waiting_[side].pop());
	waiting_[side].push(picture);
}

// The median, because a missed pulse makes an interval twice as long.
void Pairing::learn_period(int64_t interval)
{
	intervals_[interval_count_++] = interval;
	if (interval_count_ < INTERVALS)
		return;
	std::nth_element(intervals_, intervals_ + INTERVALS / 2, intervals_ + INTERVALS);
	period_ = static_cast<double>(intervals_[INTERVALS / 2]);
	tolerance_ = PAIRING_TOLERANCE * period_;
}

bool Pairing::pop(PicturePair &pair)
{
	Fifo<Picture, WAITING> &left = waiting_[PONG_LEFT], &right = waiting_[PONG_RIGHT];
	while (!left.empty() && !right.empty()) {
		const int64_t difference = right.front().utime - left.front().utime;
		if (static_cast<double>(std::abs(difference)) < tolerance_) {
			pair.utime = left.front().utime + difference / 2;
			pair.picture[PONG_LEFT] = left.pop();
			pair.picture[PONG_RIGHT] = right.pop();
			pair.miscounted =
				!check_.agrees(pair.picture[PONG_LEFT].pulses, pair.picture[PONG_RIGHT].pulses);
			pair.frame = pair.miscounted ? 0 : number_frame(pair.utime);
			miscounted_ += pair.miscounted ? 2 : 0;
			return true;
		}
		// Whatever the other side still brings is later: the earlier of the two stays alone.
		const pong_side earlier = difference > 0 ? PONG_LEFT : PONG_RIGHT;
		dismiss(earlier, waiting_[earlier].pop());
	}
	return false;
}

// Counts on from the last pair, with a period that follows the pulses: the host's clock and the trigger's differ, and
// a count from the very first pair on would be off by a frame within minutes.
int64_t Pairing::number_frame(int64_t utime)
{
	if (paired_) {
		const double interval = static_cast<double>(utime - pair_utime_);
		const double periods = std::max(1.0, std::round(interval / period_));
		constexpr double NEARBY = 8, GAIN = 0.05;
		if (periods <= NEARBY)
			period_ += GAIN * (interval / periods - period_);
		frame_ += static_cast<int64_t>(periods);
	}
	paired_ = true;
	pair_utime_ = utime;
	return frame_;
}

void Pairing::dismiss(pong_side side, const Picture &picture)
{
	unpaired_++;
	release_(side, picture);
}

void Pairing::clear()
{
	for (const pong_side side : {PONG_LEFT, PONG_RIGHT})
		while (!waiting_[side].empty())
			release_(side, waiting_[side].pop());
}

} // namespace track
