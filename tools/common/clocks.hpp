// A clock of the host in whole nanoseconds.
#pragma once

#include <cstdint>
#include <ctime>

namespace pong
{

inline int64_t read_clock_ns(clockid_t clock)
{
	timespec time;
	clock_gettime(clock, &time);
	return time.tv_sec * INT64_C(1000000000) + time.tv_nsec;
}

} // namespace pong
