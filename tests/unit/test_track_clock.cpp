#include "clock.hpp"

#include <gtest/gtest.h>
#include <random>

namespace
{

using track::ClockFit;
using track::ClockReading;

constexpr int64_t HOST = INT64_C(1700000000000000000), SECOND = 1000000000;

// A device that was switched on when the host's clock said HOST, and whose clock runs slow by `slow`.
struct Device {
	double slow;
	int64_t on = HOST;

	int64_t clock_at(int64_t host) const
	{
		return host - on - std::llround(static_cast<double>(host - on) * slow);
	}
};

TEST(TrackClock, OneReadingSetsTheOffset)
{
	ClockFit fit;
	EXPECT_FALSE(fit.known());
	fit.add({5000, HOST, HOST + 200});
	ASSERT_TRUE(fit.known());
	EXPECT_EQ(fit.host_ns(5000), HOST + 100);
	EXPECT_EQ(fit.host_ns(5000 + SECOND), HOST + 100 + SECOND);
}

TEST(TrackClock, FollowsDriftThroughNoisyReadings)
{
	const Device device{50e-6};
	std::mt19937 random(1);
	std::uniform_int_distribution<int64_t> way(15000, 40000); // ns, to the device and back
	ClockFit fit;
	for (int second = 1; second <= 120; second++) {
		const int64_t latched = HOST + second * SECOND;
		fit.add({device.clock_at(latched), latched - way(random), latched + way(random)});
		const int64_t later = latched + SECOND / 2;
		EXPECT_NEAR(static_cast<double>(fit.host_ns(device.clock_at(later)) - later), 0,
			    second < 10 ? 60000 : 15000)
			<< second;
	}
	EXPECT_NEAR(fit.drift(), 50e-6, 1e-6);
}

TEST(TrackClock, SlowRoundTripsCountForLittle)
{
	const Device device{0};
	ClockFit fit;
	for (int second = 1; second <= 20; second++) {
		const int64_t latched = HOST + second * SECOND;
		const int64_t delay = second % 4 == 0 ? 5000000 : 20000; // the answer held up by a busy host
		fit.add({device.clock_at(latched), latched - 20000, latched + delay});
	}
	const int64_t now = HOST + 20 * SECOND;
	EXPECT_NEAR(static_cast<double>(fit.host_ns(device.clock_at(now)) - now), 0, 1000);
}

TEST(TrackClock, BeginsAnewWhenAClockWasSet)
{
	Device device{20e-6};
	ClockFit fit;
	for (int second = 1; second <= 30; second++) {
		const int64_t latched = HOST + second * SECOND;
		if (second == 20)
			device.on += SECOND;
		fit.add({device.clock_at(latched), latched - 20000, latched + 20000});
		EXPECT_NEAR(static_cast<double>(fit.host_ns(device.clock_at(latched)) - latched), 0, 100000) << second;
	}
}

} // namespace
