// Which trigger pulse exposed a picture, by what pongeye-trigger says of its pulses.
//
// A picture often comes before the word of its own pulse, and now and then that word is lost. So the pulses are counted
// on, at the trigger's rate, from the nearest one that was heard of.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "pongeye.h"

namespace track
{

struct TriggerPulse {
	int64_t number; // 1 for the trigger's first
	int64_t utime;  // of its rising edge
	double rate;    // pulses a second
};

// Takes the next pulse that was heard of; false where there is none. It does not wait.
using HearPulse = std::function<bool(TriggerPulse &pulse)>;

class PulseNumbering
{
public:
	// A later pulse whose number is not larger than the last begins anew: the trigger was started again.
	void hear(const TriggerPulse &pulse);

	// The pulse whose rising edge came at this utime; none where no edge was near, or the trigger is silent.
	std::optional<int64_t> pulse_at(int64_t utime) const;

	// A camera began to expose a picture at this utime. Those of one camera come in order.
	void see(pong_side side, int64_t utime);

	// It is this utime now: of a trigger that has ended the last pulses, too, are missed some time.
	void pass_time(int64_t utime);

	// The number of the pair exposed from this utime on: its pulse's where that is known. Otherwise, and where the
	// trigger's numbers began anew, it counts on as `counted` does, which numbers the pairs without a trigger.
	int64_t frame(int64_t utime, int64_t counted);

	// Pulses heard of so far.
	int64_t heard() const
	{
		return heard_;
	}

	// Pulses of which no picture of this camera came, since its first picture.
	int64_t missed(pong_side side) const
	{
		return missed_[side];
	}

private:
	static constexpr size_t RECENT = 64;

	const TriggerPulse &newest() const
	{
		return recent_[static_cast<size_t>(heard_ - 1) % RECENT];
	}

	const TriggerPulse &nearest(int64_t utime) const;
	void begin_anew();
	void settle(pong_side side, int64_t number);

	std::array<TriggerPulse, RECENT> recent_;
	size_t count_ = 0; // of recent_, since the trigger was started
	int64_t heard_ = 0;
	std::optional<int64_t> settled_[2]; // by pong_side: seen or missed up to this pulse
	int64_t missed_[2] = {0, 0};
	bool anew_ = true; // no pair has a number of this start yet
	int64_t offset_ = 0;
	int64_t frame_ = -1, counted_ = -1; // of the last pair
};

} // namespace track
