// What one camera tells the other where something else moves.
#include <cmath>
#include <gtest/gtest.h>

#include "closer.hpp"
#include "two_sides.hpp"

namespace
{

const double ball_there[3] = {0.1, 0.3, 2.5};

// Both cameras have seen an empty room, then a ball; only the left one has found it.
class Closer : public testing::Test
{
protected:
	Closer() : left_(two_.ball_at(ball_there, PONG_LEFT))
	{
		two_.show_room();
		two_.show([this](Picture &picture, int side) { two_.draw_ball(ball_there, picture, side); });
	}

	double nearest(int side)
	{
		const pong_detection ball = two_.ball_at(ball_there, side);
		double best = INFINITY;
		for (int i = 0; i < two_[side].count(); i++) {
			const pong_detection &place = two_[side].found(i);
			best = std::min(best, std::hypot(place.u - ball.u, place.v - ball.v));
		}
		return best;
	}

	TwoSides two_;
	const pong_detection left_;
};

TEST_F(Closer, ABallNearWhereItIsExpected)
{
	two_[PONG_LEFT].look_near(left_.u + 3, left_.v - 2, left_.size);
	EXPECT_LT(nearest(PONG_LEFT), 1);
}

TEST_F(Closer, NothingWhereThereIsNoBall)
{
	two_[PONG_LEFT].look_near(left_.u + 60, left_.v, left_.size);
	EXPECT_EQ(two_[PONG_LEFT].count(), 0);
}

// Of a ball whose centre has left the picture no place is made up, though half of a faint outline seems to show there.
TEST_F(Closer, NothingBeyondTheBorder)
{
	const double leaving = -4, v = 240, size = 32;
	pong::Side &left = two_[PONG_LEFT];
	two_.show([&](Picture &picture, int) { picture.draw_ball(leaving, v, size / 2, 200); });
	left.look_near(leaving, v, size);
	EXPECT_EQ(left.count(), 0);
	pong_detection place = {leaving, v, size, 100};
	left.look_at(place);
	EXPECT_EQ(left.count(), 0);
	place.u = 4;
	left.look_at(place);
	EXPECT_GE(left.count(), 1);
}

TEST_F(Closer, OneCameraTellsTheOther)
{
	two_[PONG_LEFT].look_near(left_.u + 3, left_.v - 2, left_.size);
	ASSERT_EQ(two_[PONG_RIGHT].count(), 0);
	pong::look_closer(two_.rig(), two_[PONG_LEFT], two_[PONG_RIGHT], nullptr, true);
	EXPECT_LT(nearest(PONG_RIGHT), 1);
}

// There is room for so many places: those of the first ones stay.
TEST_F(Closer, WhatIsTooMuchIsLeftOut)
{
	pong_detection ball = left_;
	ball.contrast = 100;
	pong::Side &left = two_[PONG_LEFT];
	int count;
	do {
		count = left.count();
		left.look_at(ball);
	} while (left.count() > count);
	pong_detection elsewhere = ball;
	elsewhere.u += 100;
	left.look_at(elsewhere);
	EXPECT_EQ(left.count(), count);
	for (int i = 0; i < count; i++) {
		ASSERT_TRUE(left.ball(i)) << i;
		EXPECT_NEAR(left.ball(i)->centre.u, ball.u, 1) << i;
	}
}

} // namespace
