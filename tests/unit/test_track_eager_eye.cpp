// What the eye sees picture by picture, in the cameras' threads, is what it sees pair by pair.
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <thread>
#include <vector>

#include "eager_eye.hpp"
#include "owned.hpp"
#include "pictures.hpp"
#include "program.hpp"
#include "rigs.hpp"

namespace track
{

namespace
{

constexpr double RATE = 110;
constexpr int64_t SKEW = 30; // us that the right camera's times are later

// A ball on a parabola, frame by frame.
class EagerEyeTest : public testing::Test
{
protected:
	EagerEyeTest() : rig_(test_rig())
	{
		pong_settings_defaults(PONG_BEST, &settings_);
		for (const int side : {PONG_LEFT, PONG_RIGHT})
			for (int frame = 0; frame < FRAMES; frame++)
				pictures_[side].push_back(draw(side, frame));
	}

	pong::OwnedEye eye() const
	{
		return pong::OwnedEye(pong_eye_new(&rig_, &settings_, nullptr));
	}

	Picture draw(int side, int frame) const
	{
		const double t = frame / RATE;
		const double position[3] = {0.1 + 0.2 * t, 0.25 + 1.6 * t - 4.9 * t * t, 3.3 - 6 * t};
		double uv[2];
		pong_project(&rig_.camera[side], position, uv);
		Picture picture(640, 480, 40);
		picture.draw_ball(uv[0], uv[1], pong_apparent_size(&rig_.camera[side], position, 0.040) / 2, 200);
		picture.add_noise(1.2, static_cast<unsigned>(2 * frame + side));
		return picture;
	}

	static int64_t utime(int frame)
	{
		return std::llround((frame + 1) * 1e6 / RATE);
	}

	pong_image image(pong_side side, int frame) const
	{
		return pictures_[side][static_cast<size_t>(frame)].image();
	}

	StereoPair pair(int frame) const
	{
		return {utime(frame) + SKEW / 2, frame, image(PONG_LEFT, frame), image(PONG_RIGHT, frame), 0};
	}

	// A picture comes, in its camera's thread. Whether it was looked at.
	bool arrive(EagerEye &eager, pong_side side, int frame) const
	{
		const int64_t time = utime(frame) + (side == PONG_RIGHT ? SKEW : 0);
		const bool claimed = eager.claim(side, time, image(side, frame), true);
		if (claimed)
			eager.look(side, image(side, frame));
		return claimed;
	}

	static void see(EagerEye &eager, StereoPair &pair, pong_sight &sight)
	{
		eager.look(pair, sight);
		eager.predict(sight);
		eager.end_pair();
	}

	static constexpr int FRAMES = 30;
	pong_rig rig_;
	pong_settings settings_;
	std::vector<Picture> pictures_[2];
};

TEST_F(EagerEyeTest, SeesWhatIsSeenPairByPair)
{
	const auto early = eye(), late = eye();
	EagerEye eager(early.get(), RATE);
	int claimed = 0, balls = 0;
	for (int frame = 0; frame < FRAMES; frame++) {
		bool looked[2];
		std::thread right([&] { looked[PONG_RIGHT] = arrive(eager, PONG_RIGHT, frame); });
		looked[PONG_LEFT] = arrive(eager, PONG_LEFT, frame);
		right.join();
		claimed += looked[PONG_LEFT] + looked[PONG_RIGHT];
		StereoPair now = pair(frame);
		pong_sight sight, expected;
		see(eager, now, sight);
		EXPECT_NEAR(now.utime, pair(frame).utime, SKEW / 2 + 1);
		pong_eye_push(late.get(), now.utime, frame, &now.left, &now.right, &expected, nullptr);
		EXPECT_EQ(memcmp(&sight, &expected, sizeof sight), 0) << frame;
		balls += sight.has_ball;
	}
	EXPECT_EQ(claimed, 2 * (FRAMES - 1)) << "all but the first pair";
	EXPECT_GT(balls, 20);
}

// The cameras' exposure is the eye's from the next pair on, as if its settings had said so.
TEST_F(EagerEyeTest, TellsTheEyeHowLongTheCamerasExpose)
{
	const auto told = eye(), untold = eye();
	settings_.locate.exposure = 0.002;
	const auto set = eye();
	EagerEye eager(told.get(), 0);
	int balls = 0, alike_untold = 0;
	for (int frame = 0; frame < FRAMES; frame++) {
		StereoPair now = pair(frame);
		now.exposure_us[PONG_LEFT] = now.exposure_us[PONG_RIGHT] = 2000;
		pong_sight sight, expected, other;
		see(eager, now, sight);
		pong_eye_set_exposure(set.get(), PONG_LEFT, 0.01); // what its settings say stands
		pong_eye_push(set.get(), now.utime, frame, &now.left, &now.right, &expected, nullptr);
		pong_eye_push(untold.get(), now.utime, frame, &now.left, &now.right, &other, nullptr);
		EXPECT_EQ(memcmp(&sight, &expected, sizeof sight), 0) << frame;
		balls += sight.has_ball;
		alike_untold += memcmp(&sight.ball.centre, &other.ball.centre, sizeof sight.ball.centre) == 0;
	}
	EXPECT_GT(balls, 20);
	EXPECT_LT(alike_untold, FRAMES - 20);
}

TEST_F(EagerEyeTest, LearnsByHowMuchTheCamerasTimesDiffer)
{
	const auto one = eye();
	EagerEye eager(one.get(), RATE);
	StereoPair now;
	for (int round = 0; round < 2 * FRAMES; round++) {
		const int frame = round % FRAMES;
		const int64_t time = utime(round);
		for (const pong_side side : {PONG_RIGHT, PONG_LEFT})
			if (eager.claim(side, time + (side == PONG_RIGHT ? SKEW : 0), image(side, frame), true))
				eager.look(side, image(side, frame));
		now = pair(frame);
		now.utime = time + SKEW / 2;
		pong_sight sight;
		see(eager, now, sight);
	}
	EXPECT_NEAR(now.utime, utime(2 * FRAMES - 1) + SKEW / 2, 1);
}

// The left camera misses pulses: what the right one's picture alone has shown belongs to what a replay must show.
TEST_F(EagerEyeTest, IsRepeatedWithThePicturesThatStayedAlone)
{
	const auto early = eye(), late = eye();
	EagerEye eager(early.get(), RATE), replayed(late.get(), 0);
	int alone = 0, balls = 0;
	for (int frame = 0; frame < FRAMES; frame++) {
		const bool missed = frame % 5 == 3;
		arrive(eager, PONG_RIGHT, frame);
		if (missed) {
			if (!eager.holds(PONG_RIGHT, image(PONG_RIGHT, frame)))
				continue;
			StereoPair single = pair(frame);
			single.left = {};
			eager.look_alone(single);
			replayed.look_alone(single);
			alone++;
			continue;
		}
		arrive(eager, PONG_LEFT, frame);
		StereoPair now = pair(frame);
		pong_sight sight, expected;
		see(eager, now, sight);
		see(replayed, now, expected);
		EXPECT_EQ(memcmp(&sight, &expected, sizeof sight), 0) << frame;
		balls += sight.has_ball;
	}
	EXPECT_EQ(alone, FRAMES / 5);
	EXPECT_GT(balls, 15);
}

TEST_F(EagerEyeTest, WaitsForThePairWhereTheLastOneWasNotComplete)
{
	const auto one = eye();
	EagerEye eager(one.get(), RATE);
	pong_sight sight;
	EXPECT_FALSE(arrive(eager, PONG_LEFT, 0)) << "nothing is known of the other camera yet";
	StereoPair now = pair(0);
	see(eager, now, sight);
	EXPECT_FALSE(eager.claim(PONG_LEFT, utime(1), image(PONG_LEFT, 1), false)) << "an earlier picture waits";
	EXPECT_TRUE(arrive(eager, PONG_LEFT, 1));
	EXPECT_FALSE(arrive(eager, PONG_LEFT, 2)) << "its pair is not at its end";
	EXPECT_FALSE(arrive(eager, PONG_RIGHT, 2)) << "of another pulse";
	StereoPair single = pair(1);
	single.right = {};
	eager.look_alone(single);
	EXPECT_EQ(single.utime, utime(1));
	EXPECT_FALSE(arrive(eager, PONG_LEFT, 3));
	now = pair(3);
	see(eager, now, sight);
	EXPECT_TRUE(arrive(eager, PONG_LEFT, 4));
}

TEST_F(EagerEyeTest, SaysWhichPictureHasAnotherSize)
{
	const auto one = eye();
	EagerEye eager(one.get(), RATE);
	const Picture small(320, 240, 40);
	StereoPair now = pair(0);
	now.right = small.image();
	pong_sight sight;
	EXPECT_THROW(eager.look(now, sight), pong::Failure);
}

} // namespace

} // namespace track
