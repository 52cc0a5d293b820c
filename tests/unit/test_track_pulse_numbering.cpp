// Numbering by pulses: a trigger and cameras are played here, whose pulses are known.
#include "pulse_numbering.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace
{

using track::PulseNumbering;

constexpr double RATE = 110;
constexpr int64_t EPOCH = 1700000000000000;

int64_t edge(int64_t pulse)
{
	return EPOCH + std::llround(static_cast<double>(pulse) * 1e6 / RATE);
}

class TrackPulseNumbering : public testing::Test
{
protected:
	void hear(int64_t first, int64_t last)
	{
		for (int64_t pulse = first; pulse <= last; pulse++)
			numbering.hear({pulse, edge(pulse), RATE});
	}

	PulseNumbering numbering;
};

TEST_F(TrackPulseNumbering, KnowsNothingWithoutATrigger)
{
	EXPECT_FALSE(numbering.pulse_at(edge(1)));
	for (const int64_t counted : {0, 1, 2, 5, 6})
		EXPECT_EQ(numbering.frame(edge(counted + 1), counted), counted);
	EXPECT_EQ(numbering.heard(), 0);
}

TEST_F(TrackPulseNumbering, APulseIsKnownByItsTime)
{
	hear(1, 1000);
	for (int64_t pulse = 950; pulse <= 1000; pulse++)
		for (const int64_t jitter : {-2900, 0, 2900})
			EXPECT_EQ(numbering.pulse_at(edge(pulse) + jitter), pulse);
	EXPECT_FALSE(numbering.pulse_at(edge(999) + 4545)) << "just between two";
	EXPECT_EQ(numbering.heard(), 1000);
}

TEST_F(TrackPulseNumbering, CountsOnWherePulsesAreNotYetHeardOf)
{
	hear(1, 10);
	hear(14, 20);
	EXPECT_EQ(numbering.pulse_at(edge(12)), 12);
	EXPECT_EQ(numbering.pulse_at(edge(23)), 23);
	EXPECT_EQ(numbering.pulse_at(edge(125)), 125);
	EXPECT_FALSE(numbering.pulse_at(edge(20) + 1100000)) << "silent for more than a second";
	EXPECT_FALSE(numbering.pulse_at(edge(-3))) << "before the first";
}

TEST_F(TrackPulseNumbering, UnevenPulsesAreKnownByTheirOwnTimes)
{
	for (int64_t pulse = 1; pulse <= 50; pulse++)
		numbering.hear({pulse, edge(pulse) + (pulse % 2) * 4000, RATE});
	for (int64_t pulse = 1; pulse <= 50; pulse++)
		EXPECT_EQ(numbering.pulse_at(edge(pulse) + (pulse % 2) * 4000), pulse);
}

TEST_F(TrackPulseNumbering, CountsMissedTriggersByCamera)
{
	for (int64_t pulse = 1; pulse <= 300; pulse++) {
		if (pulse % 7 != 0) // every seventh word is lost
			hear(pulse, pulse);
		numbering.see(PONG_LEFT, edge(pulse));
		if (pulse % 10 != 0)
			numbering.see(PONG_RIGHT, edge(pulse) + 30);
	}
	EXPECT_EQ(numbering.missed(PONG_LEFT), 0);
	EXPECT_EQ(numbering.missed(PONG_RIGHT), 29) << "the last is not over yet";
}

TEST_F(TrackPulseNumbering, ACameraThatFallsSilentMisses)
{
	hear(1, 100);
	numbering.see(PONG_LEFT, edge(100));
	hear(101, 320);
	EXPECT_EQ(numbering.missed(PONG_LEFT), 110) << "but for the last second";
	EXPECT_EQ(numbering.missed(PONG_RIGHT), 0) << "which has not begun";
	numbering.see(PONG_LEFT, edge(321));
	EXPECT_EQ(numbering.missed(PONG_LEFT), 220);
}

TEST_F(TrackPulseNumbering, TheLastPulsesCanBeMissedToo)
{
	hear(1, 100);
	numbering.see(PONG_RIGHT, edge(98));
	numbering.pass_time(edge(100) + 900000);
	EXPECT_EQ(numbering.missed(PONG_RIGHT), 0) << "its pictures may still come";
	for (int i = 0; i < 2; i++)
		numbering.pass_time(edge(100) + 1100000);
	EXPECT_EQ(numbering.missed(PONG_RIGHT), 2);
	EXPECT_EQ(numbering.missed(PONG_LEFT), 0);
}

TEST_F(TrackPulseNumbering, FramesAreNumberedByPulses)
{
	EXPECT_EQ(numbering.frame(edge(4), 0), 0) << "before the trigger is heard";
	hear(1, 4);
	for (int64_t pulse = 5; pulse < 100; pulse++)
		if (pulse % 10 != 0) {
			EXPECT_EQ(numbering.frame(edge(pulse), pulse - 4), pulse);
			hear(pulse, pulse);
		}
}

TEST_F(TrackPulseNumbering, CountsOnWhereTheTriggerFallsSilent)
{
	hear(1, 500);
	EXPECT_EQ(numbering.frame(edge(500), 77), 500);
	EXPECT_EQ(numbering.frame(edge(1000), 577), 1000);
	EXPECT_EQ(numbering.frame(edge(1001) + 4000, 578), 1001);
	EXPECT_EQ(numbering.frame(edge(1003) + 4000, 580), 1003);
}

TEST_F(TrackPulseNumbering, AnotherStartOfTheTriggerDoesNotJumpBackwards)
{
	hear(1, 500);
	EXPECT_EQ(numbering.frame(edge(500), 499), 500);
	for (int64_t pulse = 1; pulse <= 10; pulse++) {
		numbering.hear({pulse, edge(700 + pulse) + 3000, RATE});
		EXPECT_EQ(numbering.frame(edge(700 + pulse) + 3000, 700 + pulse), 500 + pulse);
	}
	EXPECT_EQ(numbering.missed(PONG_LEFT), 0);
}

TEST_F(TrackPulseNumbering, AWordThatIsOvertakenBeginsNothing)
{
	hear(1, 20);
	hear(19, 19);
	EXPECT_EQ(numbering.frame(edge(21), 0), 21);
	EXPECT_EQ(numbering.heard(), 20);
}

TEST_F(TrackPulseNumbering, NoFrameComesTwice)
{
	hear(1, 20);
	EXPECT_EQ(numbering.frame(edge(21) - 2000, 0), 21);
	EXPECT_EQ(numbering.frame(edge(21) + 2000, 1), 22);
}

} // namespace
