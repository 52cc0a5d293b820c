// Which places in the two pictures are the ball.
#include <cmath>
#include <gtest/gtest.h>

#include "closer.hpp"
#include "match.hpp"
#include "two_sides.hpp"

namespace
{

const double near_robot[3] = {-0.1, 0.3, 1.2}, far_away[3] = {0.2, 0.35, 2.5};

class Match : public testing::TestWithParam<pong_profile>
{
protected:
	// Both cameras look at two pairs, with these balls in the second one.
	template<class Draw> void look(Draw draw)
	{
		two_.show_room();
		two_.show(draw);
		two_.look();
	}

	bool match(const pong::FollowedFlight &flight = {})
	{
		pong::Matcher matcher(two_.rig(), two_.settings(), flight, two_.sides());
		return matcher.match_sides(false, &match_);
	}

	double distance(const double place[3]) const
	{
		const double *at = match_.point.position;
		return std::hypot(at[0] - place[0], at[1] - place[1], at[2] - place[2]);
	}

	static pong::FollowedFlight expecting(const double place[3])
	{
		pong::FollowedFlight flight = {};
		flight.points = 5;
		flight.firm = flight.expecting = true;
		std::copy_n(place, 3, flight.expected.position);
		return flight;
	}

	TwoSides two_{GetParam()};
	pong::Match match_;
};

INSTANTIATE_TEST_SUITE_P(Profiles, Match, testing::Values(PONG_PAPER, PONG_BEST),
			 [](const auto &profile) { return profile.param == PONG_PAPER ? "paper" : "best"; });

TEST_P(Match, NothingWhereNothingIsSeen)
{
	look([](Picture &, int) {});
	EXPECT_FALSE(match());
}

TEST_P(Match, OneBallInBothPictures)
{
	look([&](Picture &picture, int side) { two_.draw_ball(near_robot, picture, side); });
	ASSERT_TRUE(match());
	EXPECT_LT(distance(near_robot), 0.02);
	if (GetParam() == PONG_BEST) {
		EXPECT_LT(match_.doubt, 0.5);
		EXPECT_LE(match_.off, match_.doubt);
	}
}

// Two balls in both pictures: the left place of one is not matched with the right place of the other, and of the two
// balls that is taken which the flight has there.
TEST_P(Match, OfTwoBallsTheOneThatIsExpected)
{
	look([&](Picture &picture, int side) {
		two_.draw_ball(near_robot, picture, side);
		two_.draw_ball(far_away, picture, side);
	});
	ASSERT_TRUE(match());
	EXPECT_LT(std::min(distance(near_robot), distance(far_away)), 0.03);
	ASSERT_TRUE(match(expecting(near_robot)));
	EXPECT_LT(distance(near_robot), 0.03);
	ASSERT_TRUE(match(expecting(far_away)));
	EXPECT_LT(distance(far_away), 0.03);
}

TEST_P(Match, NoBallOfWhatIsSeenOnce)
{
	look([&](Picture &picture, int side) { two_.draw_ball(side ? near_robot : far_away, picture, side); });
	EXPECT_FALSE(match());
}

// Both see it, but it would lie beneath the table.
TEST_P(Match, NoBallOutOfTheFlightsSpace)
{
	const double beneath[3] = {0.05, -0.1, 2.5};
	look([&](Picture &picture, int side) { two_.draw_ball(beneath, picture, side); });
	EXPECT_GE(two_[PONG_LEFT].count(), 1);
	EXPECT_GE(two_[PONG_RIGHT].count(), 1);
	EXPECT_FALSE(match());
}

class PaperMatch : public Match
{
};

INSTANTIATE_TEST_SUITE_P(Paper, PaperMatch, testing::Values(PONG_PAPER));

// By the paper, and where no flight is followed.
TEST_P(PaperMatch, OfTwoBallsTheBrighterOne)
{
	for (const bool near : {false, true}) {
		look([&](Picture &picture, int side) {
			two_.draw_ball(near_robot, picture, side, near ? 220 : 150);
			two_.draw_ball(far_away, picture, side, near ? 150 : 220);
		});
		ASSERT_TRUE(match());
		EXPECT_LT(distance(near ? near_robot : far_away), 0.03);
		two_.show_room();
	}
}

class BestMatch : public Match
{
};

INSTANTIATE_TEST_SUITE_P(Best, BestMatch, testing::Values(PONG_BEST));

// A ball and something else of the same kind whose centres agree less well.
TEST_P(BestMatch, OfTwoBallsTheOneOfLessDoubt)
{
	const double size = two_.ball_at(far_away, PONG_LEFT).size;
	look([&](Picture &picture, int side) {
		two_.draw_ball(near_robot, picture, side);
		const pong_detection other = two_.ball_at(far_away, side);
		picture.draw_ball(other.u, other.v, 0.56 * size, 250); // larger than a ball there
	});
	ASSERT_TRUE(match());
	EXPECT_LT(distance(near_robot), 0.03);
}

// The right camera does not see it. Where it must, nothing but the wall is found: that is never without doubt.
TEST_P(BestMatch, AGuidedCentreIsDoubtful)
{
	look([&](Picture &picture, int side) {
		if (side == PONG_LEFT)
			two_.draw_ball(near_robot, picture, side);
	});
	EXPECT_FALSE(match());
	pong::look_closer(two_.rig(), two_[PONG_LEFT], two_[PONG_RIGHT], nullptr, true);
	ASSERT_TRUE(match());
	EXPECT_GE(match_.off, 1);
	EXPECT_GE(match_.doubt, match_.off);
}

} // namespace
