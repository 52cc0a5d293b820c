// Time in whole nanoseconds.
#pragma once

#include <cstdint>

namespace gige
{

// CLOCK_MONOTONIC: the clock of pulses, exposures and waits.
int64_t monotonic_now();

// What CLOCK_REALTIME shows at a moment of CLOCK_MONOTONIC, by the difference of the two as it is now.
int64_t monotonic_to_realtime(int64_t time);

void sleep_until(int64_t time);

inline int64_t nanoseconds(double seconds)
{
	return static_cast<int64_t>(seconds * 1e9);
}

} // namespace gige
