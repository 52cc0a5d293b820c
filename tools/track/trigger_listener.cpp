#include "trigger_listener.hpp"

namespace track
{

bool TriggerListener::can_hear(const std::string &url)
{
	return url.rfind("udpm://", 0) == 0 || url.rfind("tcpq://", 0) == 0;
}

TriggerListener::TriggerListener(const std::string &url)
	: lcm_(url, "LCM no longer brings the trigger's pulses: frames are counted from now on")
{
	lcm_.bus().subscribe("PONGEYE_TRIGGER", &TriggerListener::on_pulse, this);
	lcm_.start();
}

void TriggerListener::on_pulse(const lcm::ReceiveBuffer *, const std::string &, const pongeye::trigger_t *message)
{
	const std::lock_guard<std::mutex> lock(mutex_);
	if (pulses_.full())
		pulses_.pop();
	pulses_.push({message->pulse, message->utime, message->rate});
}

bool TriggerListener::take(TriggerPulse &pulse)
{
	const std::lock_guard<std::mutex> lock(mutex_);
	if (pulses_.empty())
		return false;
	pulse = pulses_.pop();
	return true;
}

} // namespace track
