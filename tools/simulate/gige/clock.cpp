#include "clock.hpp"

#include <algorithm>
#include <ctime>
#include <limits>

#include "clocks.hpp"

namespace gige
{

namespace
{

constexpr int64_t second = 1000000000;

} // namespace

int64_t monotonic_now()
{
	return pong::read_clock_ns(CLOCK_MONOTONIC);
}

// One clock is read between two readings of the other. The tightest of a few tries is one that nothing interrupted.
int64_t monotonic_to_realtime(int64_t time)
{
	int64_t tightest = std::numeric_limits<int64_t>::max(), difference = 0;
	for (int i = 0; i < 4; i++) {
		const int64_t before = pong::read_clock_ns(CLOCK_MONOTONIC),
			      realtime = pong::read_clock_ns(CLOCK_REALTIME),
			      after = pong::read_clock_ns(CLOCK_MONOTONIC);
		if (after - before < tightest) {
			tightest = after - before;
			difference = realtime - (before + after) / 2;
		}
	}
	return time + difference;
}

void sleep_until(int64_t time)
{
	const timespec until = {time / second, time % second};
	while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr))
		continue; // a signal
}

} // namespace gige
