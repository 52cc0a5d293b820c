#include "overheard.hpp"

#include <cstring>

namespace track
{

Overheard::Overheard(const std::string &url)
	: lcm_(url, "LCM brings no more messages: trigger pulses are no longer recorded")
{
	lcm_.bus().subscribe("PONGEYE_TRIGGER", &Overheard::on_pulse, this);
	lcm_.bus().subscribe("PONGEYE_RECORD", &Overheard::on_request, this);
	lcm_.start();
}

void Overheard::on_pulse(const lcm::ReceiveBuffer *buffer, const std::string &)
{
	keep("PONGEYE_TRIGGER", *buffer, false);
}

void Overheard::on_request(const lcm::ReceiveBuffer *buffer, const std::string &)
{
	keep("PONGEYE_RECORD", *buffer, true);
}

void Overheard::keep(const char *channel, const lcm::ReceiveBuffer &buffer, bool asks_to_save)
{
	const std::lock_guard<std::mutex> lock(mutex_);
	if (messages_.full())
		messages_.pop();
	Message message = {channel, 0, {}, asks_to_save};
	if (buffer.data_size <= Message::CAPACITY) {
		message.size = buffer.data_size;
		memcpy(message.data, buffer.data, message.size);
	}
	messages_.push(message);
}

bool Overheard::take(Message &message)
{
	const std::lock_guard<std::mutex> lock(mutex_);
	if (messages_.empty())
		return false;
	message = messages_.pop();
	return true;
}

} // namespace track
