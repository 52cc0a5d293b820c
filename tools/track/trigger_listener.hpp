// Hears what pongeye-trigger publishes, PONGEYE_TRIGGER, in a thread of its own: whoever tracks never waits for it.
#pragma once

#include <mutex>
#include <string>

#include "fifo.hpp"
#include "lcm_thread.hpp"
#include "pongeye/trigger_t.hpp"
#include "pulse_numbering.hpp"

namespace track
{

class TriggerListener
{
public:
	// Whether others' messages come by this URL: a file or memory brings none.
	static bool can_hear(const std::string &url);

	// Throws pong::Failure where LCM cannot open the URL.
	explicit TriggerListener(const std::string &url);

	// The next pulse, in the order of their coming; false where there is none.
	bool take(TriggerPulse &pulse);

private:
	static constexpr size_t WAITING = 256; // pulses that nobody takes: the oldest are forgotten

	void on_pulse(const lcm::ReceiveBuffer *buffer, const std::string &channel, const pongeye::trigger_t *message);

	std::mutex mutex_;
	Fifo<TriggerPulse, WAITING> pulses_;
	LcmThread lcm_;
};

} // namespace track
