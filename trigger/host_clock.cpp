#include "host_clock.hpp"

#include "clocks.hpp"

namespace pong
{

int64_t monotonic_ns()
{
	return read_clock_ns(CLOCK_MONOTONIC);
}

int64_t utime_of(int64_t monotonic)
{
	const int64_t offset = read_clock_ns(CLOCK_REALTIME) - read_clock_ns(CLOCK_MONOTONIC);
	return (monotonic + offset) / 1000;
}

} // namespace pong
