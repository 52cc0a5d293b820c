// The host's clocks. Intervals and fits use the monotonic one, which nobody sets; messages carry utime.
#pragma once

#include <cstdint>

namespace pong
{

int64_t monotonic_ns();

// Microseconds since the Unix epoch, of a moment of the monotonic clock.
int64_t utime_of(int64_t monotonic);

} // namespace pong
