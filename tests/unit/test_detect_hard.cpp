// What makes a ball hard to see: lamps that flicker, other balls, balls that rest, the net, no earlier picture, balls
// that are cut, covered or branded. Drawn pictures, by the best method.
#include <cmath>
#include <gtest/gtest.h>

#include "search.hpp"

namespace
{

const pong_window around = {270, 210, 60, 60, 18, 28}; // of a ball of radius 11 at (300, 240)

class DetectHard : public testing::Test, protected Search
{
protected:
	DetectHard() : Search(PONG_DETECT_DOUBLE_DIFFERENCE)
	{
	}

	// How far from a place the nearest detection is, px.
	double nearest(int count, double u, double v) const
	{
		double best = INFINITY;
		for (int i = 0; i < count; i++)
			best = std::min(best, std::hypot(found_[i].u - u, found_[i].v - v));
		return best;
	}
};

Picture in_light(Picture picture, double gain)
{
	picture.brighten(gain);
	return picture;
}

// A lamp flickers: every picture has a brightness of its own, and nothing has come.
TEST_F(DetectHard, AFlickeringLampIsNoBall)
{
	const Picture room(width, height, 100);
	look(room, room, room);
	for (const double gain : {0.8, 0.93, 1.07, 1.2}) {
		EXPECT_EQ(look(in_light(room, gain), room, in_light(room, 1.05)), 0) << gain;
		EXPECT_EQ(look(in_light(room, gain), room, in_light(room, 1.05), &around), 0) << gain;
	}
}

TEST_F(DetectHard, FindsABallUnderAFlickeringLamp)
{
	const Picture room(width, height, 100), ball = with_ball(100, 300, 240, 11, 150);
	look(room, room, room);
	for (const double gain : {0.8, 0.93, 1.07, 1.2})
		for (const pong_window *window : {static_cast<const pong_window *>(nullptr), &around}) {
			ASSERT_EQ(look(in_light(ball, gain), room, in_light(room, 1.05), window), 1) << gain;
			EXPECT_NEAR(found_[0].u, 300, 0.5);
			EXPECT_NEAR(found_[0].v, 240, 0.5);
			EXPECT_NEAR(found_[0].size, 22, 2.2);
		}
}

TEST_F(DetectHard, FindsAllOfSeveralBalls)
{
	const double balls[5][3] = {{80, 150, 8}, {200, 260, 11}, {300, 150, 7}, {330, 300, 14}, {560, 200, 9}};
	const Picture room(width, height, 50);
	Picture current = room;
	for (const auto &ball : balls)
		current.draw_ball(ball[0], ball[1], ball[2], 180);
	const int count = look(current, room, room);
	EXPECT_EQ(count, 5);
	for (const auto &ball : balls)
		EXPECT_LT(nearest(count, ball[0], ball[1]), 0.7) << ball[0];
}

// More balls than the caller has room for: the brightest come out.
TEST_F(DetectHard, OfTooManyBallsTheBrightestComeOut)
{
	const int balls = capacity + 4, place[balls] = {5, 0, 11, 3, 8, 1, 10, 6, 2, 9, 4, 7};
	const Picture room(width, height, 50);
	Picture current = room;
	for (int i = 0; i < balls; i++)
		current.draw_ball(60 + 45 * place[i], 200, 9, 220 - 10 * i);
	ASSERT_EQ(look(current, room, room), capacity);
	for (int i = 0; i < capacity; i++)
		EXPECT_NEAR(found_[i].u, 60 + 45 * place[i], 0.7) << i;
}

// A ball that was there in all pictures is background, and hides none that comes beside it or before it.
TEST_F(DetectHard, ABallThatRestsIsBackground)
{
	const Picture rests = with_ball(50, 300, 240, 11, 180);
	EXPECT_EQ(look(rests, rests, rests), 0);
	EXPECT_EQ(look(rests, rests, rests, &around), 0);
	for (const double beside : {24.0, 40.0}) {
		Picture current = rests;
		current.draw_ball(300 + beside, 235, 11, 180);
		ASSERT_EQ(look(current, rests, rests), 1) << beside;
		EXPECT_LT(nearest(1, 300 + beside, 235), 0.7) << beside;
	}
	Picture before = rests;
	before.draw_ball(308, 235, 11, 225);
	ASSERT_GE(look(before, rests, rests), 1);
	EXPECT_LT(nearest(1, 308, 235), 3);
}

// So is the hole that it leaves, for nothing tells that from a dark ball that comes.
TEST_F(DetectHard, ABallThatRestedIsSeenWhereItMovesTo)
{
	const Picture rests = with_ball(50, 300, 240, 11, 180);
	const int count = look(with_ball(50, 340, 230, 11, 180), rests, rests);
	EXPECT_LE(count, 2);
	EXPECT_LT(nearest(count, 340, 230), 0.7);
}

// Before the net's strings, before its white band, and half before each.
TEST_F(DetectHard, FindsABallBeforeTheNet)
{
	Picture net(width, height, 60);
	net.draw_net(230, 290);
	for (const double v : {262.0, 245.0, 234.0, 226.0, 215.0}) {
		Picture current = net;
		current.draw_ball(300.4, v, 9, 190);
		ASSERT_EQ(look(current, net, net), 1) << v;
		EXPECT_LT(nearest(1, 300.4, v), 1.5) << v;
		EXPECT_NEAR(found_[0].size, 18, 2.5) << v;
	}
}

// The first picture has nothing to be compared with but itself; the second one has one earlier picture, which is both.
TEST_F(DetectHard, ComparesWithWhatThereIs)
{
	const Picture room(width, height, 50);
	Picture ball = with_ball(50, 300, 240, 11, 200);
	ball.add_noise(noise, 1);
	const pong_image current = ball.image(), earlier = room.image();
	const pong_pictures first = {current, {current, current}}, second = {current, {earlier, earlier}};
	EXPECT_EQ(pong_detect(new_detector().get(), &first, nullptr, found_, capacity), 0);
	ASSERT_EQ(pong_detect(new_detector().get(), &second, nullptr, found_, capacity), 1);
	EXPECT_LT(nearest(1, 300, 240), 0.5);
}

// The border of the picture cuts off the ball's left or upper third.
TEST_F(DetectHard, FindsABallThatTheBorderCuts)
{
	const Picture room(width, height, 50);
	ASSERT_EQ(look(with_ball(50, 4, 240, 11, 200), room, room), 1);
	EXPECT_LT(nearest(1, 4, 240), 4);
	ASSERT_EQ(look(with_ball(50, 635, 240, 11, 200), room, room), 1);
	EXPECT_LT(nearest(1, 635, 240), 4);
}

// A racket that was there before hides the ball's lower quarter.
TEST_F(DetectHard, FindsABallThatIsPartlyCovered)
{
	Picture room(width, height, 50), current = with_ball(50, 300, 240, 11, 200);
	for (Picture *picture : {&room, &current})
		picture->draw_box(250, 350, 246, 300, 30);
	ASSERT_EQ(look(current, room, room), 1);
	EXPECT_LT(nearest(1, 300, 240), 4);
}

// A dark brand in the middle, and a ball with dots all over.
TEST_F(DetectHard, FindsABrandedAndADottedBall)
{
	const Picture room(width, height, 50);
	Picture branded = with_ball(50, 300, 240, 12, 200), dotted = branded;
	branded.draw_box(295, 306, 239, 242, 45);
	for (int i = 0; i < 6; i++)
		dotted.draw_ball(300 + 7 * std::cos(i * M_PI / 3), 240 + 7 * std::sin(i * M_PI / 3), 1.5, 60);
	for (const Picture &ball : {branded, dotted})
		for (const pong_window *window : {static_cast<const pong_window *>(nullptr), &around}) {
			ASSERT_EQ(look(ball, room, room, window), 1);
			EXPECT_LT(nearest(1, 300, 240), 1);
			EXPECT_NEAR(found_[0].size, 24, 2.4);
		}
}

} // namespace
