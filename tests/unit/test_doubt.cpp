// Whether two centres are one ball's: at the limits of what a ball's do.
#include <gtest/gtest.h>

#include "doubt.hpp"
#include "rigs.hpp"

namespace
{

// A ball that both cameras see where it is. Their lines of sight to it are in one row, for they stand beside each
// other.
class Doubt : public testing::Test
{
protected:
	Doubt() : rig_(test_rig())
	{
		std::copy_n(place_, 3, point_.position);
		pong_centre *const centres[2] = {&left_, &right_};
		for (int side = 0; side < 2; side++) {
			double uv[2];
			pong_project(&rig_.camera[side], place_, uv);
			centres[side]->u = uv[0];
			centres[side]->v = uv[1];
			centres[side]->radius = pong_apparent_size(&rig_.camera[side], place_, rig_.ball.diameter) / 2;
			found_[side] = {uv[0], uv[1], 2 * centres[side]->radius, 100};
		}
		radius_ = left_.radius;
	}

	double doubt() const
	{
		return pong::doubt_of_centres(rig_, left_, right_, point_);
	}

	bool may_be_one() const
	{
		return pong::may_be_one(rig_, found_[PONG_LEFT], found_[PONG_RIGHT]);
	}

	const double place_[3] = {0.1, 0.3, 1.5};
	const pong_rig rig_;
	pong_centre left_ = {}, right_ = {};
	pong_detection found_[2];
	pong_point point_ = {};
	double radius_;
};

TEST_F(Doubt, IsNoneOfABall)
{
	EXPECT_LT(doubt(), 0.01);
	EXPECT_TRUE(may_be_one());
}

// From each other's lines: 1 px, and 3 % of the radius.
TEST_F(Doubt, GrowsWithTheDistanceFromEpipolarLines)
{
	const double reach = 1 + 0.03 * radius_;
	for (const double sign : {-1.0, 1.0}) {
		pong_centre &right = right_;
		const double v = right.v;
		right.v = v + sign * 0.9 * reach;
		EXPECT_NEAR(doubt(), 0.9, 0.02);
		right.v = v + sign * 1.1 * reach;
		EXPECT_NEAR(doubt(), 1.1, 0.02);
		right.v = v;
	}
}

// Both as much larger, or smaller, than the ball is at its distance: 6 %, and half a pixel.
TEST_F(Doubt, GrowsWithTheSizesError)
{
	const double reach = 0.06 * radius_ + 0.5;
	for (const double part : {-1.1, -0.9, 0.9, 1.1}) {
		left_.radius = right_.radius = radius_ + part * reach;
		EXPECT_NEAR(doubt(), std::abs(part), 0.02);
	}
}

// One larger, the other smaller: 3 % of the radius, and a fifth of a pixel.
TEST_F(Doubt, GrowsWithTheSizesDifference)
{
	const double reach = 0.03 * radius_ + 0.2;
	for (const double part : {0.9, 1.1}) {
		left_.radius = radius_ + part * reach / 2;
		right_.radius = radius_ - part * reach / 2;
		EXPECT_NEAR(doubt(), part, 0.02);
	}
}

TEST_F(Doubt, GrowsAsTheOutlineIsHidden)
{
	EXPECT_EQ(pong::doubt_of_outline(1), 0);
	EXPECT_LT(pong::doubt_of_outline(0.88), 1);
	EXPECT_GT(pong::doubt_of_outline(0.86), 1);
}

// What was only detected agrees less well: 3 px and a fifth of the size, a third of the size and 3 px.
TEST_F(Doubt, OfDetectionsIsRough)
{
	const double size = 2 * radius_, lines = 3 + 0.2 * size, sizes = 0.35 * size + 3;
	const pong_detection right = found_[PONG_RIGHT];
	for (const double part : {-1.1, -0.9, 0.9, 1.1}) {
		found_[PONG_RIGHT].v = right.v + part * lines;
		EXPECT_EQ(may_be_one(), std::abs(part) < 1) << part;
		found_[PONG_RIGHT] = right;
		found_[PONG_RIGHT].size = right.size + part * sizes;
		EXPECT_EQ(may_be_one(), std::abs(part) < 1) << part;
		found_[PONG_RIGHT] = right;
	}
	found_[PONG_LEFT].u -= 40; // the rays part
	EXPECT_FALSE(may_be_one());
}

} // namespace
