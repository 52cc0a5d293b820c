// Pulses as messages on PONGEYE_TRIGGER.
#pragma once

#include <lcm/lcm-cpp.hpp>
#include <string>

#include "port.hpp"

namespace pong
{

class Publisher
{
public:
	// LCM's own default where `url` is empty; then it is no failure that there is no network, and a sentence says
	// so.
	explicit Publisher(const std::string &url);

	// A pulse of unknown time is not published.
	void publish(const Pulse &pulse, double rate);

private:
	lcm::LCM lcm_;
};

} // namespace pong
