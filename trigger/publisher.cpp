#include "publisher.hpp"

#include "pongeye/trigger_t.hpp"
#include "program.hpp"

namespace pong
{

Publisher::Publisher(const std::string &url) : lcm_(url)
{
	if (lcm_.good())
		return;
	if (!url.empty())
		throw Failure("cannot publish by LCM at " + url);
	say("cannot publish by LCM, and goes on without: is there no multicast route?");
}

void Publisher::publish(const Pulse &pulse, double rate)
{
	if (!lcm_.good() || !pulse.utime)
		return;
	pongeye::trigger_t message;
	message.pulse = pulse.number;
	message.utime = pulse.utime;
	message.rate = rate;
	message.residual = pulse.residual;
	lcm_.publish("PONGEYE_TRIGGER", &message);
}

} // namespace pong
