// The tracker's watch over its own calibration, with epipolar distances drawn from known distributions.
#include "rig_watch.hpp"

#include <gtest/gtest.h>
#include <random>

namespace
{

using track::RigWatch;

// Flights of 30 balls: all of a flight err alike by 0.1 px, each by 0.3 px for itself.
struct Flights {
	RigWatch watch;
	std::mt19937_64 random{1};
	std::normal_distribution<double> unit{0, 1};
	int32_t track = 0;

	void see(int flights, double offset)
	{
		for (int i = 0; i < flights; i++) {
			const double alike = offset + 0.1 * unit(random);
			pong_ball ball = {};
			ball.track = ++track;
			for (int k = 0; k < 30; k++) {
				ball.epipolar_distance = alike + 0.3 * unit(random);
				watch.see(ball);
			}
		}
	}
};

TEST(TrackRigWatch, SaysNothingOfAGoodRig)
{
	Flights flights;
	flights.see(500, 0);
	EXPECT_TRUE(flights.watch.warning().empty());
	EXPECT_LT(std::abs(flights.watch.offset().mean), 0.15);
}

TEST(TrackRigWatch, KnowsHowWellItKnows)
{
	double squares = 0, expected = 0;
	Flights flights;
	for (int i = 0; i < 200; i++) {
		flights.see(16, 0);
		squares += std::pow(flights.watch.offset().mean, 2) / 200;
		expected += std::pow(flights.watch.offset().sigma, 2) / 200;
	}
	EXPECT_NEAR(std::sqrt(expected / squares), 1, 0.25);
}

TEST(TrackRigWatch, SaysAKnockOnce)
{
	Flights flights;
	flights.see(20, 0);
	ASSERT_FALSE(flights.watch.offset().knocked);
	flights.see(16, -0.9);
	ASSERT_TRUE(flights.watch.offset().knocked);
	EXPECT_NEAR(flights.watch.offset().mean, -0.9, 0.15);
	const std::string warning = flights.watch.warning();
	EXPECT_NE(warning.find("above"), std::string::npos) << warning;
	EXPECT_NE(warning.find("pongeye-calibrate --refine-from"), std::string::npos);
	flights.see(5, -0.9);
	EXPECT_TRUE(flights.watch.warning().empty());
	EXPECT_TRUE(flights.watch.offset().knocked);
}

// Two flights in sixteen that are none: a reflection, a bird.
TEST(TrackRigWatch, BearsFalseFlights)
{
	Flights flights;
	flights.see(14, 0);
	flights.see(2, 8);
	EXPECT_FALSE(flights.watch.offset().knocked);
	EXPECT_LT(std::abs(flights.watch.offset().mean), 0.2);
}

TEST(TrackRigWatch, JudgesNothingByAFewFlights)
{
	Flights flights;
	flights.see(6, 1); // the sixth is still flying
	EXPECT_TRUE(std::isnan(flights.watch.offset().mean));
	flights.see(1, 1);
	EXPECT_TRUE(flights.watch.offset().knocked);
}

} // namespace
