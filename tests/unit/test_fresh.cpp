// What has just come into a picture, and what has only moved a little.
#include <gtest/gtest.h>

#include "fresh.hpp"
#include "pictures.hpp"

namespace
{

const double noise = 1.5; // grey levels
const double enough = 12; // of what has just come

// An arm that moves to the right and flickers with the lamp, and a ball before it.
Picture arm(double u, double brightness, bool ball)
{
	Picture picture(640, 480, 40);
	for (int v = 100; v < 300; v += 3)
		picture.draw_ball(u + 0.2 * v, v, 16, brightness);
	if (ball)
		picture.draw_ball(u + 42, 200, 8, 230);
	picture.add_noise(noise, static_cast<unsigned>(u));
	return picture;
}

double freshness_at(const Picture &now, const Picture &before, double u, double v, double radius)
{
	const pong_image current = now.image(), previous = before.image();
	return pong::freshness(current, previous, pong::gain_between(current, previous), u, v, radius);
}

TEST(Fresh, IsABallThatComesNotAnArmThatMoves)
{
	const Picture before = arm(300, 120, false);
	EXPECT_GT(freshness_at(arm(303, 120, true), before, 345, 200, 8), enough);
	EXPECT_LT(freshness_at(arm(303, 120, false), before, 345, 200, 8), enough / 2);
	EXPECT_LT(freshness_at(arm(303, 120, false), before, 329, 200, 8), enough / 2); // its edge
}

TEST(Fresh, IsNoBallThatWasThere)
{
	EXPECT_LT(freshness_at(arm(303, 120, true), arm(300, 120, true), 345, 200, 8), enough / 2);
}

TEST(Fresh, CellsAreThoseOfTheBall)
{
	const Picture now = arm(303, 120, true), before = arm(300, 120, false);
	const auto is_fresh = [&](int u, int v) {
		return pong::is_fresh_cell(now.image(), before.image(), pong::gain_one, u / pong::cell_size,
					   v / pong::cell_size, 4 * noise);
	};
	EXPECT_TRUE(is_fresh(345, 200));
	EXPECT_FALSE(is_fresh(337, 160));
	EXPECT_FALSE(is_fresh(500, 200));
	EXPECT_FALSE(is_fresh(0, 0));
	EXPECT_FALSE(is_fresh(639, 479));
}

// Half as bright again: nothing has come.
TEST(Fresh, BearsAFlickeringLamp)
{
	Picture dim(640, 480, 80), bright(640, 480, 120);
	dim.add_noise(noise, 1);
	bright.add_noise(noise, 2);
	EXPECT_NEAR(pong::gain_between(bright.image(), dim.image()) / double(pong::gain_one), 1.5, 0.1);
	EXPECT_LT(freshness_at(bright, dim, 300, 200, 8), enough / 2);
}

// The background moves with the arm: before it, nothing but the ball is new.
TEST(Fresh, BackgroundFollowsTheArm)
{
	const Picture now = arm(303, 120, false), before = arm(300, 120, false);
	const pong_image current = now.image();
	const pong::Moved moved = pong::follow_motion(current, before.image(), {330, 360, 185, 215});
	double sum = 0;
	for (int v = 185; v < 215; v++)
		for (int u = 330; u < 360; u++) {
			const auto off = [&](const pong_image &image) {
				return std::abs(current.pixels[v * current.stride + u] -
						image.pixels[v * image.stride + u]);
			};
			sum += std::min(off(moved.image[0]), off(moved.image[1]));
		}
	EXPECT_LT(sum / 900, 3 * noise);
}

} // namespace
