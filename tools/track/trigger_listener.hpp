// Hears what pongeye-trigger publishes, PONGEYE_TRIGGER, in a thread of its own: whoever tracks never waits for it.
#pragma once

#include <atomic>
#include <lcm/lcm-cpp.hpp>
#include <mutex>
#include <string>
#include <thread>

#include "fifo.hpp"
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
	~TriggerListener();
	TriggerListener(const TriggerListener &) = delete;
	TriggerListener &operator=(const TriggerListener &) = delete;

	// The next pulse, in the order of their coming; false where there is none.
	bool take(TriggerPulse &pulse);

private:
	static constexpr size_t WAITING = 256; // pulses that nobody takes: the oldest are forgotten

	void listen();
	void on_pulse(const lcm::ReceiveBuffer *buffer, const std::string &channel, const pongeye::trigger_t *message);

	lcm::LCM lcm_;
	std::mutex mutex_;
	Fifo<TriggerPulse, WAITING> pulses_;
	std::atomic<bool> stop_{false};
	std::thread thread_;
};

} // namespace track
