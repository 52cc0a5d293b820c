// How far pixels lie outside of two earlier pictures, summed over 3 x 3, against each pixel by itself.
#include <gtest/gtest.h>
#include <random>

#include "patch.hpp"

namespace
{

const int width = 61, height = 37, stride = 83;

using Pixels = std::vector<uint8_t>;

pong_image image_of(const Pixels &pixels)
{
	return {pixels.data(), width, height, stride};
}

class Patch : public testing::Test
{
protected:
	Patch()
	{
		for (Pixels *picture : {&now_, &then_, &before_})
			for (uint8_t &pixel : *picture)
				pixel = static_cast<uint8_t>(random_());
	}

	// Signed; 0 out of the area.
	int outside(const pong::Area &area, const pong::Gains &gains, int u, int v) const
	{
		if (!area.contains(u, v))
			return 0;
		const size_t i = static_cast<size_t>(v * stride + u);
		const auto relit = [](int level, int32_t gain) {
			return (level * gain + pong::gain_one / 2) / pong::gain_one;
		};
		const int one = relit(then_[i], gains.of[0]), other = relit(before_[i], gains.of[1]);
		return now_[i] - std::clamp<int>(now_[i], std::min(one, other), std::max(one, other));
	}

	void expect_sums(const pong::Area &area, const pong::Gains &gains)
	{
		patch_.fill({image_of(now_), {image_of(then_), image_of(before_)}}, gains, area);
		for (int v = area.v_begin - 1; v <= area.v_end; v++)
			for (int u = area.u_begin - 1; u <= area.u_end; u++) {
				int sum = 0;
				for (int dv = -1; dv <= 1; dv++)
					for (int du = -1; du <= 1; du++)
						sum += outside(area, gains, u + du, v + dv);
				ASSERT_EQ(patch_.at(u, v), area.contains(u, v) ? std::abs(sum) : 0) << u << " " << v;
			}
	}

	pong::Area random_area()
	{
		const int u = static_cast<int>(random_() % width), v = static_cast<int>(random_() % height);
		return {u, u + 1 + static_cast<int>(random_()) % (width - u), v,
			v + 1 + static_cast<int>(random_()) % (height - v)};
	}

	std::minstd_rand random_{6};
	Pixels now_ = Pixels(stride * height), then_ = now_, before_ = now_;
	pong::Patch patch_{width, height};
};

// Wider and narrower than a vector, at the picture's borders too, one after the other.
TEST_F(Patch, IsWhatEachPixelIs)
{
	expect_sums({0, width, 0, height}, {{pong::gain_one, pong::gain_one}});
	for (int i = 0; i < 60; i++)
		expect_sums(random_area(), {{pong::gain_one, pong::gain_one}});
}

TEST_F(Patch, IsSeenInTodaysLight)
{
	expect_sums({0, width, 0, height}, {{pong::gain_one * 5 / 4, pong::gain_one * 2 / 3}});
	for (int i = 0; i < 60; i++)
		expect_sums(random_area(), {{pong::gain_one * 5 / 4, i % 2 ? pong::gain_one : pong::gain_one / 2}});
}

} // namespace
