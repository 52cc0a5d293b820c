// Pulses by a PWM channel of the processor, through /sys/class/pwm: exact edges, of which nobody hears.
#pragma once

#include <string>
#include <vector>

#include "port.hpp"

namespace pong
{

class PwmPort final : public Port
{
public:
	// Throws UsageError where `text` is not CHIP:CHANNEL, Failure where there is no such chip or channel, or it is
	// in use.
	explicit PwmPort(const std::string &text);
	~PwmPort() override;

	void start(const Settings &settings) override;
	bool wait(double seconds, std::vector<Pulse> *pulses) override;
	std::string stop() override;

private:
	void export_channel(const std::string &number);

	std::string chip_, channel_, number_; // the two folders, and the channel's number
	bool exported_ = false, running_ = false;
};

} // namespace pong
