// What is found, and what is not, in drawn pictures.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <gtest/gtest.h>
#include <random>

#include "cell_memory.hpp"
#include "conditions.hpp"
#include "outline.hpp"
#include "search.hpp"

namespace
{

class Detect : public testing::TestWithParam<pong_detect_method>, protected Search
{
protected:
	Detect() : Search(GetParam())
	{
	}
};

TEST_P(Detect, FindsABrightBallAndNothingElse)
{
	const Picture empty(width, height, 50);
	ASSERT_EQ(look(with_ball(50, 300.3, 240.8, 11, 200), empty, empty), 1);
	EXPECT_NEAR(found_[0].u, 300.3, 0.5);
	EXPECT_NEAR(found_[0].v, 240.8, 0.5);
	EXPECT_NEAR(found_[0].size, 22, 2.2);
	EXPECT_GT(found_[0].contrast, 100);
}

TEST_P(Detect, FindsNothingInNoise)
{
	const Picture empty(width, height, 120);
	EXPECT_EQ(look(empty, empty, empty), 0);
}

// A window narrows the search down: a ball out of it is not seen.
TEST_P(Detect, KeepsToTheWindow)
{
	const Picture empty(width, height, 50), ball = with_ball(50, 300, 240, 11, 200);
	const pong_window here = {270, 210, 60, 60, 18, 28}, elsewhere = {400, 210, 60, 60, 18, 28};
	EXPECT_EQ(look(ball, empty, empty, &here), 1);
	EXPECT_EQ(look(ball, empty, empty, &elsewhere), 0);
}

// Two balls, the brighter one first.
TEST_P(Detect, OrdersByContrast)
{
	const Picture empty(width, height, 50);
	Picture two = with_ball(50, 200, 260, 11, 120);
	two.draw_ball(400, 240, 11, 220);
	ASSERT_EQ(look(two, empty, empty), 2);
	EXPECT_NEAR(found_[0].u, 400, 1);
	EXPECT_NEAR(found_[1].u, 200, 1);
}

TEST_P(Detect, IgnoresAStripe)
{
	const Picture empty(width, height, 50);
	Picture stripe(width, height, 50);
	for (int u = 200; u < 400; u += 4)
		stripe.draw_ball(u, 240, 4, 200);
	EXPECT_EQ(look(stripe, empty, empty), 0);
}

INSTANTIATE_TEST_SUITE_P(Methods, Detect, testing::Values(PONG_DETECT_DIFFERENCE, PONG_DETECT_DOUBLE_DIFFERENCE),
			 [](const auto &method) {
				 return method.param == PONG_DETECT_DIFFERENCE ? "Difference" : "DoubleDifference";
			 });

class DoubleDifference : public Detect
{
};

INSTANTIATE_TEST_SUITE_P(Best, DoubleDifference, testing::Values(PONG_DETECT_DOUBLE_DIFFERENCE));

TEST_P(DoubleDifference, FindsADarkBall)
{
	const Picture empty(width, height, 200);
	ASSERT_EQ(look(with_ball(200, 300, 240, 11, 120), empty, empty), 1);
	EXPECT_NEAR(found_[0].u, 300, 0.5);
}

// Where the ball was is no ball now, neither before a dark nor before a bright wall.
TEST_P(DoubleDifference, SeesNoGhosts)
{
	const Picture empty(width, height, 100);
	EXPECT_EQ(look(empty, with_ball(100, 300, 240, 11, 200), with_ball(100, 400, 240, 11, 200)), 0);
	EXPECT_EQ(look(empty, with_ball(100, 300, 240, 11, 30), with_ball(100, 400, 240, 11, 30)), 0);
}

// Ten grey levels of contrast on the mean of a chequered wall, in noise of 1.5.
TEST_P(DoubleDifference, FindsABallOfLowContrast)
{
	const Picture empty(width, height, 190);
	ASSERT_EQ(look(with_ball(190, 300, 240, 11, 205), empty, empty), 1);
	EXPECT_NEAR(found_[0].u, 300, 1);
	EXPECT_NEAR(found_[0].size, 22, 4);
}

// A white ball before a white wall.
TEST_P(DoubleDifference, FindsAFaintBall)
{
	const Picture empty(width, height, 190);
	ASSERT_EQ(look(with_ball(190, 300, 240, 11, 201), empty, empty), 1); // 11 and 1 levels from the chequers
	EXPECT_NEAR(found_[0].u, 300, 4);
}

// An arm: round at its end, and everywhere as wide as a ball.
Picture with_arm(double u_end)
{
	Picture picture(width, height, 50);
	for (double u = u_end; u < width; u += 2)
		picture.draw_ball(u, 240 + 0.3 * (u - u_end), 11, 140);
	return picture;
}

TEST_P(DoubleDifference, TakesNoArmForABall)
{
	EXPECT_EQ(look(with_arm(300), with_arm(330), with_arm(360)), 0);
	EXPECT_EQ(look(with_arm(300), with_arm(270), with_arm(240)), 0);
}

TEST_P(DoubleDifference, FindsABallBeforeAnArm)
{
	Picture current = with_arm(290);
	current.draw_ball(330, 250, 12, 220);
	ASSERT_GE(look(current, with_arm(310), with_arm(340)), 1);
	EXPECT_NEAR(found_[0].u, 330, 2);
	EXPECT_NEAR(found_[0].v, 250, 2);
	EXPECT_NEAR(found_[0].size, 24, 4);
}

// A person fills the window, whose pixels tell no noise then: what whole pictures have told counts.
TEST_P(DoubleDifference, KnowsTheNoiseOfWholePictures)
{
	const Picture empty(width, height, 50);
	look(empty, empty, empty);
	Picture current = with_arm(290);
	current.draw_ball(330, 250, 12, 170);
	const pong_window window = {310, 230, 40, 40, 21, 27};
	ASSERT_GE(look(current, with_arm(310), with_arm(340), &window), 1);
	EXPECT_NEAR(found_[0].u, 330, 2);
}

// A disc shows all of its outline, a bar's end does not, and neither does what noise draws.
TEST(Outline, IsTheBallsOwn)
{
	Picture picture(width, height, 50);
	picture.draw_ball(200, 200, 10, 150);
	for (int u = 400; u < 500; u++)
		picture.draw_ball(u, 200, 10, 150);
	picture.add_noise(noise, 1);
	const pong::Outline disc = pong::measure_outline(picture.image(), 200, 200, 10, noise);
	EXPECT_EQ(disc.shown, 1);
	EXPECT_NEAR(disc.step, 95, 8); // the wall's chequers: 50 and 60
	EXPECT_LT(pong::measure_outline(picture.image(), 400, 200, 10, noise).shown, 0.87);
	Picture flat(width, height, 50);
	EXPECT_EQ(pong::measure_outline(flat.image(), 8, 8, 4, noise).shown, 0);
}

// Half of the ball is out of the picture: the other half tells. Of less than half nothing is said.
TEST(Outline, OfWhatIsInThePicture)
{
	Picture picture(width, height, 50);
	picture.draw_ball(200, 1, 10, 150);
	EXPECT_EQ(pong::measure_outline(picture.image(), 200, 1, 10, noise).shown, 1);
	picture.draw_ball(400, -6, 10, 150);
	EXPECT_EQ(pong::measure_outline(picture.image(), 400, -6, 10, noise).shown, 0);
}

// A lamp that flickers: the whole picture is a tenth brighter than before.
TEST_P(DoubleDifference, BearsAFlickeringLamp)
{
	const Picture dim(width, height, 100);
	EXPECT_EQ(look(Picture(width, height, 110), dim, dim), 0);
	ASSERT_EQ(look(with_ball(110, 300, 240, 11, 200), dim, dim), 1);
	EXPECT_NEAR(found_[0].u, 300, 0.5);
}

// Whole pictures and windows, in steady light and in another one: what is remembered is found as if it were read.
TEST_P(DoubleDifference, FindsTheSameOfWhatItRemembers)
{
	Picture current(width, height, 60), earlier(width, height, 60), dimmer(width, height, 50);
	current.draw_ball(300, 200, 9, 200);
	current.draw_ball(331, 236, 7, 150);
	for (Picture *picture : {&current, &earlier, &dimmer})
		picture->add_noise(noise, 3);
	const pong_window window = {280, 180, 80, 80, 8, 30};
	for (const Picture *before : {&earlier, &dimmer})
		for (const pong_window *where : {static_cast<const pong_window *>(nullptr), &window}) {
			const pong::OwnedDetector reading = new_detector(), remembering = new_detector();
			const pong_pictures pictures = {current.image(), {before->image(), earlier.image()}};
			pong_detection read[8], recalled[8];
			const int count = pong_detect(reading.get(), &pictures, where, read, 8);
			EXPECT_GE(count, 1);
			for (const pong_image &image : pictures.earlier)
				pong_detector_remember(remembering.get(), &image);
			ASSERT_EQ(pong_detect(remembering.get(), &pictures, where, recalled, 8), count);
			for (int i = 0; i < count; i++)
				EXPECT_EQ(memcmp(&read[i], &recalled[i], sizeof read[i]), 0) << i;
		}
}

// What is remembered is that of the picture at that place, and of no other; the oldest goes first.
TEST(CellMemory, IsBounded)
{
	std::vector<uint8_t> pixels(static_cast<size_t>(width * height) + 400, 20);
	pong::CellMemory memory(width, height, 1);
	const auto at = [&](int i) { return pong_image{pixels.data() + i, width, height, width}; };
	EXPECT_EQ(memory.cells_of(at(0)), nullptr);
	for (int i = 0; i < 300; i++)
		memory.remember(at(i));
	EXPECT_NE(memory.cells_of(at(299)), nullptr);
	EXPECT_EQ(memory.cells_of(at(1)), nullptr);
	pixels.assign(pixels.size(), 30);
	memory.remember(at(299));
	EXPECT_EQ(memory.cells_of(at(299))[0], 30 * pong::cell_pixels);
}

TEST(Cells, SumsAreThoseOfTheirPixels)
{
	const int count = 53, stride = 4 * count + 7;
	std::vector<uint8_t> pixels(4 * stride);
	std::mt19937 random(1);
	std::generate(pixels.begin(), pixels.end(), [&] { return static_cast<uint8_t>(random()); });
	uint16_t sums[count], plain[count];
	pong::sum_cells(pixels.data(), stride, count, sums);
	pong::sum_cells_plainly(pixels.data(), stride, count, plain);
	for (int i = 0; i < count; i++) {
		uint32_t expected = 0;
		for (int row = 0; row < 4; row++)
			for (int column = 0; column < 4; column++)
				expected += pixels[static_cast<size_t>(row * stride + 4 * i + column)];
		EXPECT_EQ(sums[i], expected) << i;
		EXPECT_EQ(plain[i], expected) << i;
	}
}

TEST(Cells, DifferencesAreThoseOfTheirSums)
{
	const int most = 45, room = most + pong::cells_beside;
	uint16_t now[room], then[room], before[room];
	std::mt19937 random(3);
	for (uint16_t *picture : {now, then, before})
		std::generate_n(picture, room, [&] { return random() % 4081; });
	for (int count = 1; count <= most; count++) {
		int greatest = 0;
		int16_t outside[room];
		pong::measure_outside(now, then, before, count, outside);
		for (int i = 0; i < count; i++) {
			greatest = std::max(greatest, std::abs(now[i] - then[i]));
			const int low = std::min(then[i], before[i]), high = std::max(then[i], before[i]);
			EXPECT_EQ(outside[i], std::max({0, now[i] - high, low - now[i]}));
		}
		EXPECT_EQ(pong::greatest_difference(now, then, count), greatest);
		EXPECT_EQ(pong::greatest_difference(then, now, count), greatest);
	}
	uint16_t scaled[most];
	pong::scale_cells(then, most, pong::gain_one * 5 / 4, scaled);
	for (int i = 0; i < most; i++)
		EXPECT_EQ(scaled[i], then[i] * 5 / 4);
}

// Gain and noise of what rests, though a third of the samples move.
TEST(Conditions, WhatMovesHasNoSay)
{
	pong::CellSamples samples;
	std::mt19937 random(2);
	std::normal_distribution<double> cell_noise(0, 1.0); // of a cell's mean, grey levels
	samples.count = 240;
	for (int i = 0; i < samples.count; i++) {
		const double level = 60 + i % 80;
		samples.then[i] = static_cast<uint16_t>(16 * level);
		samples.now[i] = static_cast<uint16_t>(16 * (1.08 * level + cell_noise(random) + (i % 3 ? 0 : 60)));
	}
	const int32_t gain = pong::measure_gain(samples);
	EXPECT_NEAR(gain / double(pong::gain_one), 1.08, 0.01);
	EXPECT_NEAR(pong::measure_noise(samples, gain), 1.5, 0.7); // a third that moves makes it look larger
}

} // namespace
