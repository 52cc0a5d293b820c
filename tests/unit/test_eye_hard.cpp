// The eye where its balls are hard to see or to tell apart.
#include <cmath>
#include <gtest/gtest.h>

#include "eye_scene.hpp"

namespace
{

const int gap = 8; // pairs, to the pictures that are compared

// A brightness of its own for every picture, in whole pictures and in windows.
TEST(EyeHard, FollowsABallUnderAFlickeringLamp)
{
	Scene scene(PONG_BEST);
	scene.flicker = 0.15;
	for (int i = 0; i < 20; i++) {
		EXPECT_EQ(scene.push(false), PONG_NONE);
		EXPECT_EQ(scene.sight.outcome, PONG_NOTHING);
	}
	scene.restart();
	int windowed = 0;
	for (int i = 0; i < 30; i++) {
		EXPECT_EQ(scene.push(true), PONG_FOUND) << i;
		EXPECT_EQ(scene.sight.ball.track, 1);
		EXPECT_LT(scene.error_to_truth(), 0.05);
		windowed += scene.sight.windowed;
	}
	EXPECT_GE(windowed, 25);
}

// The first pair has nothing before it; the second is compared with the first.
TEST(EyeHard, SeesABallFromTheSecondPairOn)
{
	Scene scene(PONG_BEST);
	EXPECT_EQ(scene.push(true), PONG_NONE);
	EXPECT_EQ(scene.sight.outcome, PONG_NOTHING);
	EXPECT_EQ(scene.sight.windowed, 0);
	EXPECT_EQ(scene.push(true), PONG_FOUND);
	EXPECT_LT(scene.error_to_truth(), 0.05);
}

// A pair of another size is refused, and leaves no trace in what later ones are compared with.
TEST(EyeHard, ComparesNothingWithPicturesOfAnotherSize)
{
	Scene scene(PONG_BEST), other(PONG_BEST);
	const Picture small(320, 240, 200);
	const pong_image wrong = small.image();
	int found = 0;
	for (int i = 0; i < 20; i++) {
		pong_sight sight;
		EXPECT_EQ(pong_eye_push(other.eye(), other.next_utime() - 1, 0, &wrong, &wrong, &sight, nullptr),
			  PONG_ERROR_VALUE);
		EXPECT_EQ(scene.push(true), other.push(true));
		EXPECT_EQ(scene.sight.detections[0], other.sight.detections[0]);
		EXPECT_EQ(scene.sight.ball.position[2], other.sight.ball.position[2]);
		found += other.sight.has_ball;
	}
	EXPECT_GE(found, 18);
}

// The same in steps: where one picture was refused, the pair has no ball, whatever was seen before.
TEST(EyeHard, SeesNoBallWhereOnePictureWasRefused)
{
	Scene scene(PONG_BEST);
	scene.push_many(12);
	const Picture small(320, 240, 200), empty(640, 480, 40);
	const pong_image wrong = small.image(), right = empty.image();
	ASSERT_EQ(pong_eye_expect(scene.eye(), scene.next_utime()), PONG_FOUND);
	EXPECT_EQ(pong_eye_look(scene.eye(), PONG_LEFT, &wrong, nullptr), PONG_ERROR_VALUE);
	EXPECT_EQ(pong_eye_look(scene.eye(), PONG_RIGHT, &right, nullptr), 0);
	pong_sight sight;
	EXPECT_EQ(pong_eye_join(scene.eye(), 0, &sight), PONG_NONE);
	EXPECT_EQ(sight.detections[PONG_LEFT], 0);
	EXPECT_EQ(sight.outcome, PONG_NOTHING);
}

// What one picture shows only, or both show at places that no ball has in both.
TEST(EyeHard, TellsWhyThereIsNoBall)
{
	Scene scene(PONG_BEST);
	scene.push(false);
	const double there[3] = {0.1, 0.3, 2};
	scene.behind = [&](Picture &picture, int side) {
		if (side == PONG_LEFT)
			scene.draw_ball_at(there, picture, side);
	};
	EXPECT_EQ(scene.push(false), PONG_NONE);
	EXPECT_EQ(scene.sight.outcome, PONG_ONE_EYED);
	const double lower[3] = {0.1, 0.2, 2};
	scene.behind = [&](Picture &picture, int side) {
		scene.draw_ball_at(side == PONG_LEFT ? there : lower, picture, side);
	};
	EXPECT_EQ(scene.push(false), PONG_NONE);
	EXPECT_EQ(scene.sight.outcome, PONG_MISMATCH);
}

// Where the ball was in the pictures that are compared, nothing is seen.
TEST(EyeHard, SeesNothingWhereABallHasBeen)
{
	Scene scene(PONG_BEST);
	for (int i = 0; i < 2 * gap; i++)
		scene.push(false);
	scene.restart();
	EXPECT_EQ(scene.push_many(5), 5);
	for (int i = 0; i < 3 * gap; i++) {
		scene.push(false);
		EXPECT_EQ(scene.sight.outcome, PONG_NOTHING) << i;
	}
}

// Another ball flies away beside the one that comes: both are seen, one flight is followed.
TEST(EyeHard, FollowsOneOfTwoBallsWithoutJumping)
{
	Scene scene(PONG_BEST);
	double other[3] = {-0.3, 0.35, 2.0};
	scene.behind = [&](Picture &picture, int side) { scene.draw_ball_at(other, picture, side); };
	for (int i = 0; i < 3; i++)
		scene.push(false);
	scene.restart();
	int both = 0;
	for (int i = 0; i < 30; i++) {
		other[0] += 0.01;
		other[2] += 0.03;
		ASSERT_EQ(scene.push(true), PONG_FOUND) << i;
		both += scene.sight.detections[PONG_LEFT] > 1 && scene.sight.detections[PONG_RIGHT] > 1;
		if (i < 6)
			continue;
		EXPECT_LT(scene.error_to_truth(), 0.05) << i;
		EXPECT_GE(scene.sight.observations, i - 2);
	}
	EXPECT_GE(both, 1);
}

// A ball lies on the table: seen when it has come, and background once the compared pictures show it too. Then another
// one flies over it, and at last it rolls away.
TEST(EyeHard, ABallThatRestsIsBackgroundUntilItMoves)
{
	Scene scene(PONG_BEST);
	for (int i = 0; i < 3; i++)
		scene.push(false);
	double resting[3] = {0.1, 0.02, 1.5};
	scene.behind = [&](Picture &picture, int side) { scene.draw_ball_at(resting, picture, side); };
	int seen = 0;
	for (int i = 0; i < 2 * gap; i++)
		seen += scene.push(false) == PONG_FOUND;
	EXPECT_GE(seen, gap - 1);
	for (int i = 0; i < 3 * gap; i++)
		EXPECT_EQ(scene.push(false), PONG_NONE) << i;
	EXPECT_EQ(scene.sight.outcome, PONG_NOTHING);

	scene.restart();
	for (int i = 0; i < 30; i++) {
		EXPECT_EQ(scene.push(true), PONG_FOUND) << i;
		EXPECT_LT(scene.error_to_truth(), 0.05) << i;
	}
	const int32_t flown = scene.sight.ball.track;
	for (int i = 0; i < 3 * gap; i++)
		EXPECT_EQ(scene.push(false), PONG_NONE) << i;

	int rolling = 0;
	for (int i = 0; i < 12; i++) {
		resting[0] -= 0.02;
		scene.push(false);
		const double *at = scene.sight.ball.position;
		rolling += scene.sight.has_ball && scene.sight.ball.track > flown &&
			   std::hypot(at[0] - resting[0], at[1] - resting[1], at[2] - resting[2]) < 0.05;
	}
	EXPECT_GE(rolling, 9);
}

// It rises from before the net's strings over its white band, and falls back.
TEST(EyeHard, FollowsABallBeforeTheNet)
{
	Scene scene(PONG_BEST);
	scene.behind = [](Picture &picture, int) { picture.draw_net(45, 100); };
	for (int i = 0; i < 2 * gap; i++)
		EXPECT_EQ(scene.push(false), PONG_NONE);
	scene.restart();
	for (int i = 0; i < 30; i++) {
		EXPECT_EQ(scene.push(true), PONG_FOUND) << i;
		EXPECT_LT(scene.error_to_truth(), 0.05) << i;
	}
}

// A ball that is hit leaves its window: it is found in the same pair, in whole pictures.
TEST(EyeHard, WidensTheSearchInTheSamePair)
{
	Scene scene(PONG_BEST);
	for (int i = 0; i < 3; i++)
		scene.push(false);
	scene.restart();
	scene.push_many(12);
	EXPECT_EQ(scene.sight.windowed, 1);
	const double elsewhere[3] = {-0.2, 0.3, 1.5}, back[3] = {0.5, 1, 4};
	scene.serve(elsewhere, back);
	scene.push(true);
	EXPECT_EQ(scene.sight.windowed, 0);
	EXPECT_EQ(scene.sight.detections[PONG_LEFT], 1);
	EXPECT_EQ(scene.sight.detections[PONG_RIGHT], 1);
	EXPECT_EQ(scene.sight.outcome, PONG_REJECTED); // it is no point of the flight; further ones will begin another
	EXPECT_GE(scene.push_many(6), 4);
	EXPECT_EQ(scene.sight.ball.track, 2);
	EXPECT_LT(scene.error_to_truth(), 0.05);
}

// It flies out of the picture: until half of it is gone it is followed, and flagged.
TEST(EyeHard, FlagsABallThatTheBorderCuts)
{
	Scene scene(PONG_BEST);
	for (int i = 0; i < 3; i++)
		scene.push(false);
	const double begin[3] = {0.2, 0.3, 1.2}, speed[3] = {1.2, 1, 0};
	scene.serve(begin, speed);
	int whole = 0, cut = 0;
	for (int i = 0; i < 40; i++) {
		if (scene.push(true) != PONG_FOUND)
			continue;
		const pong_centre &left = scene.sight.ball.centre[PONG_LEFT];
		const pong_centre &right = scene.sight.ball.centre[PONG_RIGHT];
		const bool inside = std::min(left.u - left.radius, right.u - right.radius) > 2;
		EXPECT_LT(scene.error_to_truth(), inside ? 0.03 : 0.1) << i;
		if (inside) {
			EXPECT_EQ(left.flags | right.flags, 0u) << i;
		}
		whole += inside;
		cut += ((left.flags | right.flags) & PONG_CENTRE_CUT) != 0;
	}
	EXPECT_GE(whole, 8);
	EXPECT_GE(cut, 2);
}

// A dark brand, off the ball's middle, and dots: they cost little.
TEST(EyeHard, FollowsABrandedAndADottedBall)
{
	for (const bool dotted : {false, true}) {
		Scene scene(PONG_BEST);
		scene.before = [&](Picture &picture, int side) {
			double uv[2];
			pong_project(&scene.rig().camera[side], scene.position(), uv);
			const double radius =
				pong_apparent_size(&scene.rig().camera[side], scene.position(), 0.040) / 2;
			for (int i = 0; i < 6 && dotted; i++)
				picture.draw_ball(uv[0] + 0.6 * radius * std::cos(i * M_PI / 3),
						  uv[1] + 0.6 * radius * std::sin(i * M_PI / 3), 0.12 * radius, 90);
			if (!dotted)
				picture.draw_ball(uv[0] + 0.3 * radius, uv[1] - 0.2 * radius, 0.3 * radius, 60);
		};
		scene.push(false);
		const double begin[3] = {0.1, 0.25, 2}, speed[3] = {0.1, 1.6, -2};
		scene.serve(begin, speed);
		for (int i = 0; i < 30; i++) {
			ASSERT_EQ(scene.push(true), PONG_FOUND) << i;
			EXPECT_EQ(scene.sight.ball.track, 1);
			EXPECT_LT(scene.error_to_truth(), 0.02) << i << dotted;
		}
	}
}

// It falls behind a racket that rests in front of it, and comes out below.
TEST(EyeHard, FollowsABallThatIsPartlyCovered)
{
	Scene scene(PONG_BEST);
	const int top = 200, bottom = 216; // rows
	scene.before = [](Picture &picture, int) { picture.draw_box(200, 440, top, bottom, 10); };
	for (int i = 0; i < 2 * gap; i++)
		scene.push(false);
	const double begin[3] = {0.05, 0.25, 1.5}, speed[3] = {0.3, 1, -0.5};
	scene.serve(begin, speed);
	int partly = 0, below = 0;
	for (int i = 0; i < 34; i++) {
		if (scene.push(true) != PONG_FOUND)
			continue;
		const pong_centre &left = scene.sight.ball.centre[PONG_LEFT];
		EXPECT_EQ(scene.sight.ball.track, 1);
		EXPECT_LT(scene.error_to_truth(), 0.03) << i;
		partly += left.v + left.radius > top + 2 && left.v - left.radius < bottom - 2;
		below += left.v - left.radius > bottom;
	}
	EXPECT_GE(partly, 2);
	EXPECT_GE(below, 1);
}

} // namespace
