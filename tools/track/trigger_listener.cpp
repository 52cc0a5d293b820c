#include "trigger_listener.hpp"

#include "program.hpp"

namespace track
{

namespace
{

constexpr int PATIENCE_MS = 100; // how soon the thread sees that it is to end

} // namespace

bool TriggerListener::can_hear(const std::string &url)
{
	return url.rfind("udpm://", 0) == 0 || url.rfind("tcpq://", 0) == 0;
}

TriggerListener::TriggerListener(const std::string &url) : lcm_(url)
{
	if (!lcm_.good())
		throw pong::Failure("LCM URL " + url + ": LCM cannot open it");
	lcm_.subscribe("PONGEYE_TRIGGER", &TriggerListener::on_pulse, this);
	thread_ = std::thread([this] { listen(); });
}

TriggerListener::~TriggerListener()
{
	stop_ = true;
	thread_.join();
}

void TriggerListener::listen()
{
	while (!stop_)
		if (lcm_.handleTimeout(PATIENCE_MS) < 0) {
			pong::say("LCM no longer brings the trigger's pulses: frames are counted from now on");
			return;
		}
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
