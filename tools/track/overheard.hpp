// Hears what others say that belongs into a recording, in a thread of its own: the trigger's pulses (PONGEYE_TRIGGER),
// and whoever wants the last seconds kept (PONGEYE_RECORD).
#pragma once

#include <mutex>
#include <string>

#include "fifo.hpp"
#include "lcm_thread.hpp"

namespace track
{

class Overheard
{
public:
	struct Message {
		static constexpr size_t CAPACITY = 512; // bytes: far above any of these; larger ones are not kept
		const char *channel;
		size_t size;
		uint8_t data[CAPACITY];
		bool asks_to_save;
	};

	// Throws pong::Failure where LCM cannot open the URL.
	explicit Overheard(const std::string &url);

	// The next message, in the order of their coming; false where there is none.
	bool take(Message &message);

private:
	static constexpr size_t WAITING = 256; // messages that nobody takes: the oldest are forgotten

	void on_pulse(const lcm::ReceiveBuffer *buffer, const std::string &channel);
	void on_request(const lcm::ReceiveBuffer *buffer, const std::string &channel);
	void keep(const char *channel, const lcm::ReceiveBuffer &buffer, bool asks_to_save);

	std::mutex mutex_;
	Fifo<Message, WAITING> messages_;
	LcmThread lcm_;
};

} // namespace track
