// The parts of pongeye-trigger that need no device.
#include <gtest/gtest.h>

#include <cmath>
#include <lcm/lcm-cpp.hpp>
#include <random>

#include "pongeye/trigger_t.hpp"
#include "trigger/clock_fit.hpp"
#include "trigger/gpio_lines.hpp"
#include "trigger/lateness.hpp"
#include "trigger/publisher.hpp"
#include "trigger/settings.hpp"

#include "program.hpp"

namespace
{

// A clock that is 80 ppm fast, asked ten times a second; the answer comes from anywhere within the round trip.
class Asked
{
public:
	explicit Asked(uint32_t first_tick) : first_(first_tick)
	{
	}

	uint32_t tick_at(int64_t ns) const
	{
		const double ticks = static_cast<double>(ns) * 16e-3 * (1 + 80e-6);
		return first_ + static_cast<uint32_t>(std::llround(ticks));
	}

	void ask(pong::ClockFit *fit, int64_t ns)
	{
		const bool slow = random_() % 3 == 0;
		const double out = 60e3 + uniform_(random_) * (slow ? 3e6 : 15e3);
		const double back = 60e3 + uniform_(random_) * 15e3;
		fit->add(ns, ns + std::llround(out + back), tick_at(ns + std::llround(out)));
	}

private:
	uint32_t first_;
	std::mt19937 random_{3};
	std::uniform_real_distribution<double> uniform_{0, 1};
};

TEST(ClockFit, FindsTheTimeOfATickThroughSlowRoundTripsAndAWrap)
{
	Asked clock(4'000'000'000u); // wraps after 18 s
	pong::ClockFit fit(16e6);
	double worst = 0;
	for (int64_t ns = 0; ns < 60'000'000'000; ns += 100'000'000) {
		clock.ask(&fit, ns);
		const int64_t moment = ns + 37'000'000;
		if (ns > 3'000'000'000)
			worst = std::max(worst,
					 std::abs(static_cast<double>(fit.host_ns(clock.tick_at(moment)) - moment)));
	}
	EXPECT_TRUE(fit.settled());
	EXPECT_LT(worst, 10e3);
	EXPECT_GT(fit.residual(), 1e-6);
	EXPECT_LT(fit.residual(), 8e-6);
	EXPECT_GT(fit.fastest(), 120e-6);
	EXPECT_LT(fit.fastest(), 125e-6);
}

TEST(ClockFit, SettlesOnlyAfterSomeTimeAndSomeSamples)
{
	Asked clock(0);
	pong::ClockFit quick(16e6), few(16e6);
	for (int i = 0; i < 50; i++)
		clock.ask(&quick, i * 1'000'000);
	EXPECT_FALSE(quick.settled()) << "in 50 ms";
	for (int i = 0; i < 5; i++)
		clock.ask(&few, i * 500'000'000);
	EXPECT_FALSE(few.settled()) << "from five";
}

TEST(Lateness, CountsAndSorts)
{
	pong::Lateness lateness;
	for (const double seconds : {5e-6, 15e-6, 15e-6, 199e-6, 201e-6, 0.5})
		lateness.add(seconds);
	EXPECT_EQ(lateness.late(), 2);
	EXPECT_EQ(lateness.worst(), 0.5);
	const std::string text = lateness.text();
	EXPECT_NE(text.find("<    20 us  2\n"), std::string::npos) << text;
	EXPECT_NE(text.find("<   500 us  1\n"), std::string::npos) << text;
	EXPECT_NE(text.find(">= 10000 us  1\n"), std::string::npos) << text;
}

TEST(Settings, ImpossibleOnesAreRefused)
{
	pong::Settings settings;
	settings.rate = 100;
	settings.width = 0.009;
	EXPECT_NO_THROW(pong::check_settings(settings));
	settings.exposure = 0.0101;
	EXPECT_THROW(pong::check_settings(settings), pong::UsageError);
	settings.exposure = 0;
	settings.width = 0.01;
	EXPECT_THROW(pong::check_settings(settings), pong::UsageError);
}

TEST(GpioSpec, NamesAChipAndOneOrTwoLines)
{
	const pong::GpioSpec spec = pong::parse_gpio("gpiochip0:CAM_LEFT,17");
	EXPECT_EQ(spec.chip, "gpiochip0");
	EXPECT_EQ(spec.lines, (std::vector<std::string>{"CAM_LEFT", "17"}));
	EXPECT_EQ(pong::parse_gpio("/dev/gpiochip1:4").lines.size(), 1u);
	for (const char *bad : {"", ":", "gpiochip0", "gpiochip0:", "gpiochip0:1,", "gpiochip0:1,2,3", "gpiochip0:1,1"})
		EXPECT_THROW(pong::parse_gpio(bad), pong::UsageError) << bad;
}

using Messages = std::vector<pongeye::trigger_t>;

void on_trigger(const lcm::ReceiveBuffer *, const std::string &, const pongeye::trigger_t *message, Messages *heard)
{
	heard->push_back(*message);
}

TEST(Publisher, IsHeardByASubscriber)
{
	const char *const url = "udpm://239.255.76.68:7868?ttl=0";
	lcm::LCM lcm(url);
	ASSERT_TRUE(lcm.good()) << "no multicast: ip route add 224.0.0.0/4 dev lo";
	Messages heard;
	lcm.subscribeFunction("PONGEYE_TRIGGER", on_trigger, &heard);
	pong::Publisher publisher(url);
	publisher.publish({1, 0, 0, NAN}, 110); // its time is not known yet
	publisher.publish({2, 1'700'000'000'000'000, 12e-6, NAN}, 110);
	publisher.publish({3, 1'700'000'000'009'090, 12e-6, NAN}, 110);
	while (heard.size() < 2)
		ASSERT_GT(lcm.handleTimeout(5000), 0);
	EXPECT_EQ(heard[0].pulse, 2);
	EXPECT_EQ(heard[0].utime, 1'700'000'000'000'000);
	EXPECT_EQ(heard[1].pulse, 3);
	EXPECT_EQ(heard[1].rate, 110);
	EXPECT_EQ(heard[1].residual, 12e-6);
	EXPECT_THROW(pong::Publisher("nonsense://"), pong::Failure);
}

} // namespace
