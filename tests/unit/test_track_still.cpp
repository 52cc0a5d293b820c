// A frozen camera is told from one that sees nothing move.
#include <gtest/gtest.h>

#include "pictures.hpp"
#include "still.hpp"

namespace track
{

namespace
{

bool is_repeated(Still &still, const Picture &picture)
{
	const bool repeated = still.is_repeated(picture.image());
	still.remember(picture.image());
	return repeated;
}

TEST(TrackStill, FindsTheSamePictureAgain)
{
	Picture picture(64, 48, 40);
	picture.add_noise(1.2, 1);
	Still still(64, 48);
	EXPECT_FALSE(is_repeated(still, picture));
	EXPECT_TRUE(is_repeated(still, picture));
	EXPECT_TRUE(is_repeated(still, picture));
}

TEST(TrackStill, TakesNoiseForLife)
{
	Still still(64, 48);
	for (unsigned seed = 1; seed <= 20; seed++) {
		Picture picture(64, 48, 40);
		picture.add_noise(1.2, seed);
		EXPECT_FALSE(is_repeated(still, picture));
	}
}

TEST(TrackStill, SeesTheSmallestBallMoveWithoutNoise)
{
	Still still(64, 48);
	for (int row = 10; row < 30; row++) {
		Picture picture(64, 48, 40);
		picture.draw_ball(30, row, 2, 200);
		EXPECT_FALSE(is_repeated(still, picture)) << row;
		EXPECT_TRUE(is_repeated(still, picture)) << row;
	}
}

} // namespace

} // namespace track
