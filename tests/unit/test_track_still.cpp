// A frozen camera is told from one that sees nothing move.
#include <gtest/gtest.h>

#include "pictures.hpp"
#include "still.hpp"

namespace track
{

namespace
{

TEST(TrackStill, FindsTheSamePictureAgain)
{
	Picture picture(64, 48, 40);
	picture.add_noise(1.2, 1);
	Still still(64, 48);
	EXPECT_FALSE(still.is_repeated(picture.image()));
	EXPECT_TRUE(still.is_repeated(picture.image()));
	EXPECT_TRUE(still.is_repeated(picture.image()));
}

TEST(TrackStill, TakesNoiseForLife)
{
	Still still(64, 48);
	for (unsigned seed = 1; seed <= 20; seed++) {
		Picture picture(64, 48, 40);
		picture.add_noise(1.2, seed);
		EXPECT_FALSE(still.is_repeated(picture.image()));
	}
}

TEST(TrackStill, SeesTheSmallestBallMoveWithoutNoise)
{
	Still still(64, 48);
	for (int row = 10; row < 30; row++) {
		Picture picture(64, 48, 40);
		picture.draw_ball(30, row, 2, 200);
		EXPECT_FALSE(still.is_repeated(picture.image())) << row;
		EXPECT_TRUE(still.is_repeated(picture.image())) << row;
	}
}

} // namespace

} // namespace track
