// How far a ball is believed, and the limits on doubtful points amid people.
#include <gtest/gtest.h>

#include "trust.hpp"
#include "two_sides.hpp"

namespace
{

using pong::Trust;

const double there[3] = {0.1, 0.3, 2};

// A flight whose ball is expected there, known to 2 cm, at so many m/s.
pong::FollowedFlight flight_of_speed(double speed)
{
	pong::FollowedFlight flight = {};
	flight.points = 5;
	flight.expecting = true;
	flight.expected.has_spin = 1;
	std::copy_n(there, 3, flight.expected.position);
	flight.expected.velocity[2] = -speed;
	for (int axis = 0; axis < 3; axis++)
		flight.expected.covariance[axis][axis] = 0.02 * 0.02;
	return flight;
}

// So far from where the ball is expected.
pong::Match match_at(double distance, double off)
{
	pong::Match match = {};
	std::copy_n(there, 3, match.point.position);
	match.point.position[1] += distance;
	match.off = match.doubt = off;
	return match;
}

const double doubtful = 1.2; // centres that hardly agree

// A doubtful point is at most 6 cm and 2.5 standard deviations from there: of 2 cm, 11 cm.
TEST(Hopeless, IsWhatIsDoubtfulAndFarFromWhereItIsExpected)
{
	const pong::FollowedFlight flight = flight_of_speed(6);
	EXPECT_FALSE(is_hopeless(match_at(0.10, doubtful), Trust::none, flight));
	EXPECT_TRUE(is_hopeless(match_at(0.12, doubtful), Trust::none, flight));
	EXPECT_FALSE(is_hopeless(match_at(0.12, 0.9), Trust::none, flight)); // its centres agree
	EXPECT_FALSE(is_hopeless(match_at(0.12, doubtful), Trust::likely, flight));
	EXPECT_TRUE(is_hopeless(match_at(0, doubtful), Trust::none, {})); // nothing is expected
}

TEST(Hopeless, AreMoreThanEightDoubtfulOnesInARow)
{
	pong::FollowedFlight flight = flight_of_speed(6);
	const pong::Match match = match_at(0.01, 1);
	for (int i = 0; i < 8; i++) {
		EXPECT_FALSE(is_hopeless(match, Trust::none, flight)) << i;
		count_point(match, PONG_TRACK_FOLLOWED, &flight);
	}
	EXPECT_TRUE(is_hopeless(match, Trust::none, flight));
	count_point(match_at(0.01, 0.9), PONG_TRACK_FOLLOWED, &flight); // one that agrees: all begins again
	EXPECT_FALSE(is_hopeless(match, Trust::none, flight));
	EXPECT_EQ(flight.last.position[1], there[1] + 0.01);
}

// No better than to 0.13 m, in the worst direction.
TEST(HardlyKnown, UnlessNothingElseCanLookSo)
{
	pong_settings settings;
	pong_settings_defaults(PONG_BEST, &settings);
	pong_point point = {};
	point.covariance[2][2] = 0.12 * 0.12;
	EXPECT_FALSE(is_hardly_known(point, Trust::none, settings));
	point.covariance[2][2] = 0.14 * 0.14;
	EXPECT_TRUE(is_hardly_known(point, Trust::none, settings));
	EXPECT_TRUE(is_hardly_known(point, Trust::usual, settings));
	EXPECT_FALSE(is_hardly_known(point, Trust::certain, settings));
	pong_settings_defaults(PONG_PAPER, &settings);
	EXPECT_FALSE(is_hardly_known(point, Trust::usual, settings));
}

// What was doubtful of the flight before says nothing of a new one.
TEST(Hopeless, AreCountedByFlight)
{
	pong::FollowedFlight flight = flight_of_speed(6);
	const pong::Match match = match_at(0.01, doubtful);
	for (int i = 0; i < 8; i++)
		count_point(match, PONG_TRACK_FOLLOWED, &flight);
	count_point(match, PONG_TRACK_BEGUN, &flight);
	EXPECT_EQ(flight.doubtful, 1);
	EXPECT_FALSE(is_hopeless(match, Trust::none, flight));
}

// What is followed for three points, and slower than 2.5 m/s, is an arm.
TEST(Hopeless, IsWhatMovesAsAnArm)
{
	const pong::Match match = match_at(0.01, 0.5);
	EXPECT_FALSE(is_hopeless(match, Trust::none, flight_of_speed(2.6)));
	EXPECT_TRUE(is_hopeless(match, Trust::none, flight_of_speed(2.4)));
	EXPECT_FALSE(is_hopeless(match, Trust::likely, flight_of_speed(2.4)));
	pong::FollowedFlight young = flight_of_speed(2.4);
	young.points = 2;
	EXPECT_FALSE(is_hopeless(match, Trust::none, young));
}

// The deviation is 1.5 times as large, and with the square of how badly the centres agree.
TEST(Doubted, PointsAreLessCertain)
{
	pong::Match match = match_at(0, 0.5);
	for (int axis = 0; axis < 3; axis++)
		match.point.covariance[axis][axis] = 1e-6;
	EXPECT_NEAR(pong::doubted(match).covariance[1][1], 2.25e-6, 1e-12);
	match.off = 2;
	EXPECT_NEAR(pong::doubted(match).covariance[2][2], 2.25e-6 * 16, 1e-11);
	EXPECT_EQ(pong::doubted(match).position[2], there[2]);
}

// A ball, with or without an arm that moves beside it, seen for the first or the second time.
class TrustOf : public testing::Test
{
protected:
	void show(bool arm, int balls)
	{
		two_.show_room();
		for (int i = 2; i > 0; i--)
			two_.show([&](Picture &picture, int side) {
				for (double u = 300 - 4 * i; arm && u < 600; u += 5)
					picture.draw_ball(u, 300 + 0.3 * (u - 300), 12, 130);
				if (i <= balls)
					two_.draw_ball(there, picture, side);
			});
		two_.look();
		ASSERT_EQ(cluttered(two_.sides()), arm);
	}

	Trust trust(double off, double doubt)
	{
		pong_centre centre[2] = {};
		for (int side = 0; side < 2; side++) {
			const pong_detection ball = two_.ball_at(there, side);
			centre[side].u = ball.u;
			centre[side].v = ball.v;
			centre[side].radius = ball.size / 2;
		}
		return pong::trust_of({&centre[PONG_LEFT], &centre[PONG_RIGHT], {}, doubt, off}, two_.sides(),
				      settings_);
	}

	TwoSides two_;
	pong_settings settings_ = two_.settings();
};

TEST_F(TrustOf, WhatIsAloneIsABall)
{
	show(false, 1);
	EXPECT_EQ(trust(0.5, 0.9), Trust::certain);
	EXPECT_EQ(trust(0.5, 1.1), Trust::usual);
	settings_.detect.method = PONG_DETECT_DIFFERENCE;
	EXPECT_EQ(trust(0.5, 0.9), Trust::usual);
}

TEST_F(TrustOf, WhatHasJustComeAmidOthersIsABall)
{
	show(true, 1);
	EXPECT_EQ(trust(0.4, 1.1), Trust::certain); // its centres agree well
	EXPECT_EQ(trust(0.6, 0.9), Trust::certain);
	EXPECT_EQ(trust(0.6, 1.1), Trust::usual);
	EXPECT_EQ(trust(0.4, 3.6), Trust::none); // an outline of which nothing shows
}

// Beside an arm that is another place in the same picture.
TEST_F(TrustOf, WhatHasBeenThereAmidOthersMayBeAHand)
{
	show(true, 2);
	EXPECT_EQ(trust(0.4, 0.9), Trust::likely);
	EXPECT_EQ(trust(0.4, 2.1), Trust::none);
}

} // namespace
