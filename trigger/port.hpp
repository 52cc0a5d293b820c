// What makes the pulses: a microcontroller on USB, GPIO lines, or a PWM channel.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "settings.hpp"

namespace pong
{

struct Pulse {
	int64_t number = 0;    // 1 for the first
	int64_t utime = 0;     // of the leading edge; 0 while the port does not know it
	double residual = 0;   // of the fit between the port's clock and ours, s
	double lateness = NAN; // behind the schedule, s; NaN where a timer made the edge
};

class Port
{
public:
	// Leaves the lines inactive.
	virtual ~Port() = default;

	// Throws UsageError where this port cannot do what is wanted, Failure where the world does not let it.
	virtual void start(const Settings &settings) = 0;

	// Waits up to `seconds`, or until a signal or a pulse comes, and appends the pulses made since, in order.
	// Returns false once all that were asked for have been made.
	virtual bool wait(double seconds, std::vector<Pulse> *pulses) = 0;

	// Ends the pulses and leaves the lines inactive. Returns what is to be said in the end; may be empty.
	virtual std::string stop() = 0;
};

} // namespace pong
