#include "host_clock.hpp"

#include <ctime>

namespace pong
{

namespace
{

int64_t now_ns(clockid_t clock)
{
	timespec now;
	clock_gettime(clock, &now);
	return now.tv_sec * INT64_C(1000000000) + now.tv_nsec;
}

} // namespace

int64_t monotonic_ns()
{
	return now_ns(CLOCK_MONOTONIC);
}

int64_t utime_of(int64_t monotonic)
{
	const int64_t offset = now_ns(CLOCK_REALTIME) - now_ns(CLOCK_MONOTONIC);
	return (monotonic + offset) / 1000;
}

} // namespace pong
