// What a rally does to a track: balls struck back, two at once, gaps, late and repeated points.
#include <cmath>
#include <gtest/gtest.h>

#include "flights.hpp"
#include "owned.hpp"
#include "track.hpp"

namespace
{

class Track : public testing::Test
{
protected:
	Track() : rig_(rig_of_simulator())
	{
		pong_settings settings;
		pong_settings_defaults(PONG_BEST, &settings);
		track_.reset(pong_track_new(&rig_, &settings, nullptr));
	}

	int push_all(const std::vector<pong_point> &points)
	{
		int followed = 0;
		for (const pong_point &point : points)
			followed += pong_track_push(track_.get(), &point) != PONG_TRACK_REJECTED;
		return followed;
	}

	const pong_rig rig_;
	pong::OwnedTrack track_;
	const sim::Flight flight_ = fly(usual_serve());
	const std::vector<pong_point> points_ = points_of(flight_, 0, 0.6, 110, 0.002);
};

TEST_F(Track, FollowsAFlightThroughItsBounce)
{
	EXPECT_EQ(push_all(points_), static_cast<int>(points_.size()));
	EXPECT_EQ(pong_track_id(track_.get()), 1);
	EXPECT_EQ(pong_track_count(track_.get()), static_cast<int>(points_.size()));
}

TEST_F(Track, AGapOfTenFramesLosesNothing)
{
	std::vector<pong_point> gapped(points_.begin(), points_.begin() + 20);
	gapped.insert(gapped.end(), points_.begin() + 30, points_.end());
	EXPECT_EQ(push_all(gapped), static_cast<int>(gapped.size()));
	EXPECT_EQ(pong_track_id(track_.get()), 1);
}

TEST_F(Track, LateAndRepeatedPointsAreRejected)
{
	push_all({points_.begin(), points_.begin() + 20});
	EXPECT_EQ(pong_track_push(track_.get(), &points_[19]), PONG_TRACK_REJECTED);
	EXPECT_EQ(pong_track_push(track_.get(), &points_[5]), PONG_TRACK_REJECTED);
	EXPECT_EQ(pong_track_count(track_.get()), 20);
}

TEST_F(Track, APointThatIsNotFiniteIsRejected)
{
	push_all({points_.begin(), points_.begin() + 10});
	pong_point point = points_[10];
	point.position[1] = NAN;
	EXPECT_EQ(pong_track_push(track_.get(), &point), PONG_TRACK_REJECTED);
	EXPECT_EQ(pong_track_push(track_.get(), &points_[11]), PONG_TRACK_FOLLOWED);
}

TEST_F(Track, AnOutlierIsRejected)
{
	push_all({points_.begin(), points_.begin() + 20});
	pong_point point = points_[20];
	point.position[0] += 0.4;
	EXPECT_EQ(pong_track_push(track_.get(), &point), PONG_TRACK_REJECTED);
	EXPECT_EQ(pong_track_push(track_.get(), &points_[21]), PONG_TRACK_FOLLOWED);
}

// The robot hits at the end of the serve: the ball flies away from it.
TEST_F(Track, ABallStruckBackIsANewFlight)
{
	push_all(points_);
	sim::Ball ball = flight_.at(0.6);
	ball.velocity = {0.3, 1.5, 6};
	auto back = points_of(fly(ball), 0.01, 0.2, 110, 0.002);
	for (pong_point &point : back)
		point.utime += 600000;
	push_all(back);
	EXPECT_EQ(pong_track_id(track_.get()), 2);
	pong_state state;
	ASSERT_TRUE(pong_track_state(track_.get(), &state));
	EXPECT_GT(state.velocity[2], 3);
}

TEST_F(Track, OfTwoBallsTheOneThatComesIsFollowed)
{
	sim::Ball away = usual_serve();
	away.position = {-0.4, 0.3, 0.4};
	away.velocity = {0.1, 1, 5};
	const auto other = points_of(fly(away), 0, 0.25, 110, 0.002);
	for (size_t i = 0; i < other.size(); i++) {
		pong_track_push(track_.get(), &other[i]);
		pong_point point = points_[i];
		point.utime += 3000; // the second ball in the same frame, or nearly
		pong_track_push(track_.get(), &point);
	}
	pong_state state;
	ASSERT_TRUE(pong_track_state(track_.get(), &state));
	EXPECT_LT(state.velocity[2], 0);
}

// What may be a hand begins no flight, and is believed only where the ball has just been.
TEST_F(Track, WhatMayBeAHandOnlyContinues)
{
	for (int i = 0; i < 10; i++)
		EXPECT_EQ(pong::push_point(*track_, points_[i], pong::Trust::none), PONG_TRACK_REJECTED);
	for (int i = 10; i < 20; i++)
		pong_track_push(track_.get(), &points_[i]);
	EXPECT_EQ(pong::push_point(*track_, points_[20], pong::Trust::none), PONG_TRACK_FOLLOWED);
	EXPECT_EQ(pong::push_point(*track_, points_[40], pong::Trust::none), PONG_TRACK_REJECTED);
	EXPECT_EQ(pong::push_point(*track_, points_[41], pong::Trust::likely), PONG_TRACK_FOLLOWED);
}

TEST_F(Track, WhatIsLikelyABallNeedsASecondSight)
{
	EXPECT_EQ(pong::push_point(*track_, points_[0], pong::Trust::likely), PONG_TRACK_REJECTED);
	EXPECT_EQ(pong_track_id(track_.get()), 0);
	EXPECT_EQ(pong::push_point(*track_, points_[1], pong::Trust::likely), PONG_TRACK_BEGUN);
	EXPECT_EQ(pong_track_count(track_.get()), 2);
}

// An arm that was likely a ball is not the point before a ball's first one.
TEST_F(Track, ALikelyPointFarOffIsNoFirstOne)
{
	pong_point arm = points_[0];
	arm.position[0] += 0.4;
	EXPECT_EQ(pong::push_point(*track_, arm, pong::Trust::likely), PONG_TRACK_REJECTED);
	EXPECT_EQ(pong::push_point(*track_, points_[1], pong::Trust::likely), PONG_TRACK_REJECTED);
	EXPECT_EQ(pong::push_point(*track_, points_[2], pong::Trust::likely), PONG_TRACK_BEGUN);
}

// A flight of doubtful points gives way to two better ones elsewhere; one of good points needs three.
TEST_F(Track, AnUnsureFlightGivesWaySoon)
{
	for (const pong::Trust trust : {pong::Trust::none, pong::Trust::likely}) {
		pong_settings settings;
		pong_settings_defaults(PONG_BEST, &settings);
		track_.reset(pong_track_new(&rig_, &settings, nullptr));
		pong_track_push(track_.get(), &points_[0]);
		for (int i = 1; i < 6; i++)
			ASSERT_EQ(pong::push_point(*track_, points_[i], trust), PONG_TRACK_FOLLOWED);
		pong_point elsewhere[2] = {points_[6], points_[7]};
		for (pong_point &point : elsewhere)
			point.position[0] += 0.5;
		EXPECT_EQ(pong::push_point(*track_, elsewhere[0], pong::Trust::likely), PONG_TRACK_REJECTED);
		EXPECT_EQ(pong::push_point(*track_, elsewhere[1], pong::Trust::likely),
			  trust == pong::Trust::none ? PONG_TRACK_BEGUN : PONG_TRACK_REJECTED);
	}
}

// A ball that was taken away and put elsewhere.
TEST_F(Track, ACertainBallElsewhereIsANewFlightSoon)
{
	push_all({points_.begin(), points_.begin() + 4});
	pong_point point = points_[10];
	point.position[0] += 0.6;
	EXPECT_EQ(pong::push_point(*track_, point, pong::Trust::usual), PONG_TRACK_REJECTED);
	point.utime++;
	EXPECT_EQ(pong::push_point(*track_, point, pong::Trust::certain), PONG_TRACK_BEGUN);
	EXPECT_EQ(pong_track_id(track_.get()), 2);
}

TEST_F(Track, ALostBallEndsTheFlight)
{
	push_all({points_.begin(), points_.begin() + 10});
	pong_track_miss(track_.get(), points_[9].utime + 1000000);
	EXPECT_EQ(pong_track_id(track_.get()), 0);
	EXPECT_EQ(pong_track_count(track_.get()), 0);
}

} // namespace
