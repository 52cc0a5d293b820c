// Hears what others say that belongs into a recording, in a thread of its own: the trigger's pulses (PONGEYE_TRIGGER),
// and whoever wants the last seconds kept (PONGEYE_RECORD).
#pragma once

#include <atomic>
#include <lcm/lcm-cpp.hpp>
#include <mutex>
#include <string>
#include <thread>

#include "fifo.hpp"

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
	~Overheard();
	Overheard(const Overheard &) = delete;
	Overheard &operator=(const Overheard &) = delete;

	// The next message, in the order of their coming; false where there is none.
	bool take(Message &message);

private:
	static constexpr size_t WAITING = 256; // messages that nobody takes: the oldest are forgotten

	void listen();
	void on_pulse(const lcm::ReceiveBuffer *buffer, const std::string &channel);
	void on_request(const lcm::ReceiveBuffer *buffer, const std::string &channel);
	void keep(const char *channel, const lcm::ReceiveBuffer &buffer, bool asks_to_save);

	lcm::LCM lcm_;
	std::mutex mutex_;
	Fifo<Message, WAITING> messages_;
	std::atomic<bool> stop_{false};
	std::thread thread_;
};

} // namespace track
