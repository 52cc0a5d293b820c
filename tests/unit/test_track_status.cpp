#include "latency.hpp"
#include "status.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace
{

using namespace track;

constexpr int64_t SECOND = 1000000000;

pong_sight sight_of(pong_outcome outcome, double epipolar = 0)
{
	pong_sight sight = {};
	sight.outcome = outcome;
	sight.has_ball = outcome == PONG_SEEN;
	sight.ball.epipolar_distance = epipolar;
	return sight;
}

TEST(TrackLatencies, Percentiles)
{
	Latencies latencies;
	for (int i = 1000; i >= 1; i--)
		latencies.add(i * 1e-5);
	EXPECT_NEAR(latencies.percentile(0.5), 5e-3, 5e-5);
	EXPECT_NEAR(latencies.percentile(0.99), 9.9e-3, 1e-4);
	EXPECT_EQ(latencies.max(), 1e-2);
	EXPECT_LE(latencies.percentile(1), latencies.max());
}

TEST(TrackLatencies, OfNoneAreAbsent)
{
	Latencies latencies;
	EXPECT_TRUE(std::isnan(latencies.percentile(0.5)));
	EXPECT_TRUE(std::isnan(latencies.max()));
	latencies.add(1e-3);
	latencies.clear();
	EXPECT_TRUE(std::isnan(latencies.percentile(0.5)));
}

TEST(TrackLatencies, OutOfRange)
{
	Latencies latencies;
	latencies.add(0);
	latencies.add(1e6);
	EXPECT_LE(latencies.percentile(0.5), 1e-5);
	EXPECT_EQ(latencies.max(), 1e6);
}

// A source that only counts.
class Counts : public Source
{
public:
	Next next(StereoPair &) override
	{
		return Next::END;
	}

	Dropped dropped() const override
	{
		return lost;
	}

	Pulses pulses() const override
	{
		return heard;
	}

	CameraHealth health(pong_side side) const override
	{
		return cameras[side];
	}

	Dropped lost;
	Pulses heard;
	CameraHealth cameras[2];
};

TEST(TrackStatus, CountsOutcomesAndRates)
{
	Status status(0);
	for (int i = 0; i < 30; i++)
		status.count(sight_of(PONG_SEEN, i % 2 ? 0.3 : -0.1), 1e-3);
	for (int i = 0; i < 10; i++)
		status.count(sight_of(PONG_NOTHING), 5e-3);
	status.count(sight_of(PONG_OUT_OF_ORDER), 5e-3);
	EXPECT_FALSE(status.second_over(SECOND - 1));
	ASSERT_TRUE(status.second_over(2 * SECOND));
	Counts source;
	source.lost.unpaired = 2;
	source.lost.incomplete = 3;
	status.close_second(2 * SECOND, source);
	EXPECT_EQ(status.report().pairs, 41);
	EXPECT_EQ(status.report().outcomes[PONG_SEEN], 30);
	EXPECT_EQ(status.report().outcomes[PONG_NOTHING], 10);
	EXPECT_EQ(status.report().dropped, 6);
	EXPECT_DOUBLE_EQ(status.report().pair_rate, 20.5);
	EXPECT_DOUBLE_EQ(status.report().ball_rate, 15);
	EXPECT_NEAR(status.report().latency_median, 1e-3, 1e-5) << "pairs without a ball have no latency";
	EXPECT_NEAR(status.report().epipolar_mean, 0.1, 1e-12);
	EXPECT_NEAR(status.report().epipolar_rms, std::sqrt(0.05), 1e-12);
}

TEST(TrackStatus, RatesAndLatencyAreOfTheLastSecond)
{
	Status status(0);
	for (int i = 0; i < 100; i++)
		status.count(sight_of(PONG_SEEN), 1);
	status.close_second(SECOND, Counts());
	for (int i = 0; i < 10; i++)
		status.count(sight_of(PONG_SEEN), 1e-3);
	status.close_second(2 * SECOND, Counts());
	EXPECT_DOUBLE_EQ(status.report().pair_rate, 10);
	EXPECT_EQ(status.report().pairs, 110);
	EXPECT_DOUBLE_EQ(status.report().latency_max, 1e-3);
	status.close_second(3 * SECOND, Counts());
	EXPECT_TRUE(std::isnan(status.report().latency_median));
}

TEST(TrackStatus, SummaryNamesEveryCause)
{
	Status status(0);
	status.count(sight_of(PONG_SEEN), 2e-3);
	Counts source;
	source.lost.unpaired = 1;
	source.lost.incomplete = 2;
	source.lost.late = 4;
	EXPECT_EQ(status.summary(source),
		  "1 pairs, 1 with a ball; 7 pictures dropped (1 without a partner, 2 incomplete, 4 too late, "
		  "0 out of order); latency searching median 2.00 ms, p99 2.00 ms, max 2.00 ms");
	source.heard = {50, {3, 4}};
	source.lost.repeated = 5;
	source.cameras[PONG_RIGHT].losses = 6;
	EXPECT_NE(status.summary(source).find(
			  "; 5 of a frozen camera; the left camera was lost 0 times, the right 6 times; 50 trigger "
			  "pulses heard, missed by the left camera 3, by the right 4; latency"),
		  std::string::npos);
}

TEST(TrackStatus, ReportsMissedTriggers)
{
	Status status(0);
	Counts source;
	source.heard = {50, {3, 4}};
	source.cameras[PONG_LEFT] = {CameraState::FROZEN, 2};
	status.close_second(SECOND, source);
	EXPECT_EQ(status.report().cameras[PONG_LEFT].state, CameraState::FROZEN);
	EXPECT_EQ(status.report().cameras[PONG_LEFT].losses, 2);
	EXPECT_EQ(status.report().missed_left, 3);
	EXPECT_EQ(status.report().missed_right, 4);
	EXPECT_EQ(status.report().dropped, 0) << "they never were pictures";
}

} // namespace
