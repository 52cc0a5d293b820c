// The trigger line: when its pulses come, and that each is counted once.
#include <gtest/gtest.h>

#include "gige/trigger_line.hpp"

using namespace gige;

TEST(GigeLine, PulsesDontDrift)
{
	const Schedule schedule{1000, 110};
	EXPECT_EQ(schedule.time(0), 1000);
	EXPECT_EQ(schedule.time(1), 1000 + 9090909);
	EXPECT_EQ(schedule.time(110 * 3600), 1000 + 3600LL * 1000000000);
}

TEST(GigeLine, FirstFromIsTheLeast)
{
	const Schedule schedule{5000, 333};
	for (int64_t k = 0; k < 1000; k++) {
		EXPECT_EQ(schedule.first_from(schedule.time(k)), k);
		EXPECT_EQ(schedule.first_from(schedule.time(k) + 1), k + 1);
	}
	EXPECT_EQ(schedule.first_from(-1000000), 0);
}

TEST(GigeLine, IsStillUntilStarted)
{
	TriggerLine line(100, 0);
	EXPECT_FALSE(line.next(0).has_value());
	EXPECT_FALSE(line.take(1000000000).has_value());
	EXPECT_FALSE(line.next_time().has_value());
	EXPECT_EQ(line.count(), 0);
}

TEST(GigeLine, EveryPulseComesOnceAndInOrder)
{
	TriggerLine line(100, 0);
	line.start(1000);
	EXPECT_FALSE(line.take(999).has_value());
	for (int64_t number = 1; number <= 3; number++) {
		const auto pulse = line.take(1000 + 20000000);
		ASSERT_TRUE(pulse.has_value());
		EXPECT_EQ(pulse->number, number);
		EXPECT_EQ(pulse->time, 1000 + (number - 1) * 10000000);
	}
	EXPECT_FALSE(line.take(1000 + 20000000).has_value());
	EXPECT_EQ(line.count(), 3);
}

TEST(GigeLine, GoesOnCountingAfterAPause)
{
	TriggerLine line(100, 0);
	line.start(0);
	line.take(0);
	line.take(10000000);
	line.stop();
	EXPECT_FALSE(line.next(0).has_value());
	line.start(500000000);
	const auto pulse = line.next(0);
	ASSERT_TRUE(pulse.has_value());
	EXPECT_EQ(pulse->number, 3);
	EXPECT_EQ(pulse->time, 500000000);
}

TEST(GigeLine, EndsWhereItIsTold)
{
	TriggerLine line(100, 0);
	line.end_at(2);
	line.start(0);
	EXPECT_TRUE(line.next(10000000).has_value());
	EXPECT_FALSE(line.next(10000001).has_value());
	EXPECT_TRUE(line.take(1000000000).has_value());
	EXPECT_FALSE(line.has_ended());
	EXPECT_TRUE(line.take(1000000000).has_value());
	EXPECT_FALSE(line.take(1000000000).has_value());
	EXPECT_TRUE(line.has_ended());
}

TEST(GigeLine, TheWorldGoesOnWithoutPulses)
{
	TriggerLine line(100, 7000);
	EXPECT_EQ(line.number_at(7000), 1);
	EXPECT_EQ(line.number_at(7000 + 1000000000), 101);
}

TEST(GigeLine, EdgesFromOutsideAreItsPulses)
{
	TriggerLine line(100, 0);
	line.connect_outside();
	EXPECT_FALSE(line.next(0).has_value());
	line.add_edge(5000);
	line.add_edge(12000);
	line.add_edge(31000);
	EXPECT_EQ(line.next(0)->number, 1);
	EXPECT_EQ(line.next(5001)->number, 2);
	EXPECT_EQ(line.next(5001)->time, 12000);
	EXPECT_FALSE(line.next(31001).has_value());
	EXPECT_EQ(line.take(20000)->number, 1);
	EXPECT_EQ(line.take(20000)->time, 12000);
	EXPECT_FALSE(line.take(20000).has_value());
	EXPECT_EQ(line.next_time(), 31000);
}

TEST(GigeLine, OldEdgesFromOutsideAreForgotten)
{
	TriggerLine line(100, 0);
	line.connect_outside();
	for (int64_t number = 1; number <= 1000; number++) {
		line.add_edge(number * 1000);
		EXPECT_EQ(line.take(number * 1000)->number, number);
	}
	const auto oldest = line.next(0);
	ASSERT_TRUE(oldest.has_value());
	EXPECT_EQ(oldest->time, oldest->number * 1000);
	EXPECT_EQ(line.next(999001)->number, 1000);
}
