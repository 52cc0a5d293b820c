#include "pulse_numbering.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace track
{

namespace
{

// Of a period. Half is the limit; a third leaves room for the errors of both clocks.
constexpr double TOLERANCE = 1.0 / 3;

// So far are pulses counted on from one that was heard of, s: a trigger that is silent for longer has stopped, and
// crystals drift apart by no more than 0.1 ms meanwhile. A picture that has not come by then will not.
constexpr double HORIZON = 1;

} // namespace

void PulseNumbering::hear(const TriggerPulse &pulse)
{
	const bool overtaken = count_ > 0 && pulse.utime <= newest().utime; // on its way: nothing new
	if (!(pulse.rate > 0) || pulse.number < 1 || overtaken)
		return;
	if (count_ > 0 && pulse.number <= newest().number)
		begin_anew();
	recent_[static_cast<size_t>(heard_++) % RECENT] = pulse;
	count_ = std::min(count_ + 1, RECENT);
	for (const pong_side side : {PONG_LEFT, PONG_RIGHT})
		settle(side, pulse.number - static_cast<int64_t>(std::ceil(HORIZON * pulse.rate)));
}

void PulseNumbering::begin_anew()
{
	count_ = 0;
	settled_[PONG_LEFT].reset();
	settled_[PONG_RIGHT].reset();
	anew_ = true;
}

const TriggerPulse &PulseNumbering::nearest(int64_t utime) const
{
	const TriggerPulse *best = &newest();
	for (size_t i = 1; i < count_; i++) {
		const TriggerPulse &older = recent_[(static_cast<size_t>(heard_ - 1) - i) % RECENT];
		if (std::abs(older.utime - utime) > std::abs(best->utime - utime))
			break;
		best = &older;
	}
	return *best;
}

std::optional<int64_t> PulseNumbering::pulse_at(int64_t utime) const
{
	if (count_ == 0)
		return std::nullopt;
	const TriggerPulse &pulse = nearest(utime);
	const double since = static_cast<double>(utime - pulse.utime) * 1e-6; // s
	const double periods = since * pulse.rate, whole = std::round(periods);
	if (std::abs(since) > HORIZON || std::abs(periods - whole) >= TOLERANCE)
		return std::nullopt;
	const int64_t number = pulse.number + static_cast<int64_t>(whole);
	return number >= 1 ? std::optional<int64_t>(number) : std::nullopt;
}

void PulseNumbering::see(pong_side side, int64_t utime)
{
	const std::optional<int64_t> number = pulse_at(utime);
	if (!number)
		return;
	if (!settled_[side])
		settled_[side] = *number;
	if (*number <= *settled_[side])
		return;
	settle(side, *number - 1);
	settled_[side] = *number;
}

void PulseNumbering::pass_time(int64_t utime)
{
	if (count_ == 0 || static_cast<double>(utime - newest().utime) * 1e-6 <= HORIZON)
		return;
	for (const pong_side side : {PONG_LEFT, PONG_RIGHT})
		settle(side, newest().number);
}

// What has not come up to this pulse was missed.
void PulseNumbering::settle(pong_side side, int64_t number)
{
	if (!settled_[side] || number <= *settled_[side])
		return;
	missed_[side] += number - *settled_[side];
	settled_[side] = number;
}

int64_t PulseNumbering::frame(int64_t utime, int64_t counted)
{
	const std::optional<int64_t> number = pulse_at(utime);
	if (number && anew_) {
		offset_ = std::max<int64_t>(0, frame_ + 1 - *number);
		anew_ = false;
	}
	const bool by_pulse = number && *number + offset_ > frame_;
	frame_ = by_pulse ? *number + offset_ : frame_ + (counted - counted_);
	counted_ = counted;
	return frame_;
}

} // namespace track
