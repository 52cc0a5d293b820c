// What one camera tells the other where something else moves.
#include <cmath>
#include <gtest/gtest.h>

#include "closer.hpp"
#include "pictures.hpp"
#include "rigs.hpp"

namespace
{

const double ball_there[3] = {0.1, 0.3, 2.5};

// Both cameras have seen an empty room, then a ball; only the left one has found it.
class Closer : public testing::Test
{
protected:
	Closer() : rig_(test_rig())
	{
		pong_settings settings;
		pong_settings_defaults(PONG_BEST, &settings);
		for (int i = 0; i < 2; i++) {
			side_.push_back(std::make_unique<pong::Side>(rig_, static_cast<pong_side>(i), settings));
			pong_project(&rig_.camera[i], ball_there, uv_[i]);
			const double size = pong_apparent_size(&rig_.camera[i], ball_there, rig_.ball.diameter);
			now_[i].draw_ball(uv_[i][0], uv_[i][1], size / 2, 200);
			before_[i].add_noise(1.2, static_cast<unsigned>(i));
			now_[i].add_noise(1.2, static_cast<unsigned>(2 + i));
			side_[static_cast<size_t>(i)]->add(before_[i].image());
			side_[static_cast<size_t>(i)]->keep();
			side_[static_cast<size_t>(i)]->add(now_[i].image());
		}
		size_ = pong_apparent_size(&rig_.camera[PONG_LEFT], ball_there, rig_.ball.diameter);
	}

	double nearest(int side) const
	{
		double best = INFINITY;
		for (int i = 0; i < side_[static_cast<size_t>(side)]->count(); i++) {
			const pong_detection &place = side_[static_cast<size_t>(side)]->found(i);
			best = std::min(best, std::hypot(place.u - uv_[side][0], place.v - uv_[side][1]));
		}
		return best;
	}

	pong_rig rig_;
	std::vector<std::unique_ptr<pong::Side>> side_;
	Picture before_[2] = {Picture(640, 480, 40), Picture(640, 480, 40)};
	Picture now_[2] = {Picture(640, 480, 40), Picture(640, 480, 40)};
	double uv_[2][2], size_;
};

TEST_F(Closer, ABallNearWhereItIsExpected)
{
	side_[PONG_LEFT]->look_near(uv_[PONG_LEFT][0] + 3, uv_[PONG_LEFT][1] - 2, size_);
	EXPECT_LT(nearest(PONG_LEFT), 1);
}

TEST_F(Closer, NothingWhereThereIsNoBall)
{
	side_[PONG_LEFT]->look_near(uv_[PONG_LEFT][0] + 60, uv_[PONG_LEFT][1], size_);
	EXPECT_EQ(side_[PONG_LEFT]->count(), 0);
}

TEST_F(Closer, OneCameraTellsTheOther)
{
	side_[PONG_LEFT]->look_near(uv_[PONG_LEFT][0] + 3, uv_[PONG_LEFT][1] - 2, size_);
	ASSERT_EQ(side_[PONG_RIGHT]->count(), 0);
	pong::look_closer(rig_, *side_[PONG_LEFT], *side_[PONG_RIGHT], nullptr, true);
	EXPECT_LT(nearest(PONG_RIGHT), 1);
}

} // namespace
