// The stages joined: flights drawn by the test, pushed pair by pair.
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>

#include "eye_scene.hpp"

namespace
{

class Eye : public testing::TestWithParam<pong_profile>
{
};

INSTANTIATE_TEST_SUITE_P(Profiles, Eye, testing::Values(PONG_PAPER, PONG_BEST),
			 [](const auto &profile) { return profile.param == PONG_PAPER ? "paper" : "best"; });

TEST_P(Eye, FollowsABallAndPredictsItsHit)
{
	Scene scene(GetParam());
	for (int i = 0; i < 3; i++)
		EXPECT_EQ(scene.push(false), PONG_NONE);
	scene.restart();
	int found = 0, windowed = 0;
	for (int i = 0; i < 30; i++) {
		found += scene.push(true) == PONG_FOUND;
		if (!scene.sight.has_ball)
			continue;
		EXPECT_LT(scene.error_to_truth(), GetParam() == PONG_PAPER ? 0.08 : 0.05);
		EXPECT_EQ(scene.sight.ball.track, 1);
		windowed += scene.sight.windowed;
	}
	EXPECT_GE(found, 29);
	EXPECT_GE(windowed, 20);
	ASSERT_TRUE(scene.sight.has_prediction && scene.sight.prediction.has_hit);
	EXPECT_NEAR(scene.sight.prediction.hit.position[2], 0, 1e-6);
	EXPECT_NEAR(scene.sight.prediction.hit.position[0], scene.hit_x(), 0.08);
	EXPECT_NEAR(scene.sight.ball.velocity[2], -6, 1.0);
}

TEST_P(Eye, LosesTheBallAndFindsTheNextOne)
{
	Scene scene(GetParam());
	for (int flight = 1; flight <= 2; flight++) {
		for (int i = 0; i < 25; i++)
			EXPECT_EQ(scene.push(false), PONG_NONE);
		EXPECT_EQ(scene.sight.outcome, PONG_NOTHING);
		scene.restart();
		for (int i = 0; i < 12; i++)
			scene.push(true);
		ASSERT_TRUE(scene.sight.has_ball);
		EXPECT_EQ(scene.sight.ball.track, flight);
		EXPECT_LE(scene.sight.observations, 12);
	}
}

TEST_P(Eye, FindsANewBallAtOnceWhereTheOldOneIsGone)
{
	Scene scene(GetParam());
	for (int i = 0; i < 3; i++)
		scene.push(false);
	scene.restart();
	for (int i = 0; i < 12; i++)
		scene.push(true);
	for (int i = 0; i < 14; i++)
		scene.push(false);
	scene.restart();
	EXPECT_EQ(scene.push(true), PONG_FOUND);
	EXPECT_EQ(scene.sight.ball.track, 2);
}

TEST_P(Eye, SeesNothingWhereNothingMoves)
{
	Scene scene(GetParam());
	for (int i = 0; i < 20; i++) {
		EXPECT_EQ(scene.push(false), PONG_NONE);
		EXPECT_EQ(scene.sight.outcome, PONG_NOTHING);
	}
}

// With nothing else there, and before something that moves, where circles are searched for.
TEST_P(Eye, AllocatesNothingInTheSteadyLoop)
{
	for (const bool clutter : {false, true}) {
		Scene scene(GetParam());
		scene.clutter = clutter;
		for (int i = 0; i < 3; i++)
			scene.push(false);
		scene.restart();
		scene.allocated = 0;
		int predicted = 0, more = 0;
		for (int i = 0; i < 30; i++) {
			scene.push(true);
			predicted += scene.sight.has_prediction;
			more += scene.sight.detections[PONG_LEFT] > 1 || scene.sight.detections[PONG_RIGHT] > 1;
		}
		EXPECT_TRUE(!clutter || more > 0) << "the arm was not looked at";
		EXPECT_GT(predicted, 5);
		EXPECT_EQ(scene.allocated, 0);
	}
}

void expect_same(const pong_sight &one, const pong_sight &other)
{
	EXPECT_EQ(one.outcome, other.outcome);
	EXPECT_EQ(one.windowed, other.windowed);
	EXPECT_EQ(one.detections[0], other.detections[0]);
	EXPECT_EQ(one.detections[1], other.detections[1]);
	EXPECT_EQ(one.observations, other.observations);
	EXPECT_EQ(memcmp(one.ball.position, other.ball.position, sizeof one.ball.position), 0);
	EXPECT_EQ(memcmp(one.ball.covariance, other.ball.covariance, sizeof one.ball.covariance), 0);
	EXPECT_EQ(memcmp(&one.ball.centre, &other.ball.centre, sizeof one.ball.centre), 0);
	ASSERT_EQ(one.has_prediction, other.has_prediction);
	if (one.has_prediction) {
		EXPECT_EQ(one.prediction.hit.utime, other.prediction.hit.utime);
		EXPECT_EQ(memcmp(one.prediction.hit.position, other.prediction.hit.position, sizeof(double[3])), 0);
	}
}

TEST_P(Eye, LooksInTwoThreadsToTheSameBits)
{
	Scene one(GetParam()), other(GetParam());
	other.in_two_threads = true;
	int balls = 0;
	for (int i = 0; i < 30; i++) {
		const bool ball = i >= 3 && i != 20; // once it is not where it was expected
		EXPECT_EQ(one.push(ball), other.push(ball));
		expect_same(one.sight, other.sight);
		balls += one.sight.has_ball;
	}
	EXPECT_GT(balls, 20);
}

// A picture that is not kept need not outlive the pair, and nothing is compared with it.
TEST_P(Eye, ForgetsPicturesThatAreNotKept)
{
	Scene one(GetParam()), other(GetParam());
	for (int i = 0; i < 20; i++) {
		if (i % 3 == 2) {
			const Picture gone(640, 480, 200);
			const pong_image image = gone.image();
			EXPECT_EQ(pong_eye_expect(other.eye(), other.next_utime() - 1), PONG_FOUND);
			pong_eye_look(other.eye(), PONG_LEFT, &image, nullptr);
			pong_eye_look(other.eye(), PONG_RIGHT, &image, nullptr);
		}
		EXPECT_EQ(one.push(true), other.push(true));
	}
	EXPECT_TRUE(one.sight.has_ball);
	EXPECT_LT(other.error_to_truth(), one.error_to_truth() + 0.001);
}

TEST_P(Eye, ExpectsOnlyLaterPairs)
{
	Scene scene(GetParam());
	EXPECT_EQ(pong_eye_expect(scene.eye(), 5), PONG_FOUND);
	EXPECT_EQ(pong_eye_expect(scene.eye(), 5), PONG_NONE);
}

TEST_P(Eye, DropsPairsThatAreNotLater)
{
	Scene scene(GetParam());
	scene.push(false);
	const Picture picture(640, 480, 40);
	const pong_image image = picture.image();
	pong_sight sight;
	EXPECT_EQ(pong_eye_push(scene.eye(), 5, 1, &image, &image, &sight, nullptr), PONG_NONE);
	EXPECT_EQ(sight.outcome, PONG_OUT_OF_ORDER);
	EXPECT_EQ(sight.has_ball, 0);
}

TEST_P(Eye, RefusesPicturesOfAnotherSize)
{
	Scene scene(GetParam());
	const Picture picture(640, 480, 40), small(320, 240, 40);
	const pong_image image = picture.image(), wrong = small.image();
	pong_sight sight;
	pong_error error;
	EXPECT_EQ(pong_eye_push(scene.eye(), 5, 1, &image, &wrong, &sight, &error), PONG_ERROR_VALUE);
	EXPECT_STREQ(error.text, "the right picture is 320 x 240, its camera in the rig 640 x 480");
	EXPECT_EQ(sight.has_ball, 0);
}

} // namespace
