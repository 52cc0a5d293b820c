// Cells and their differences, by every way to them, against sums of pixels one by one.
#include <algorithm>
#include <cstdlib>
#include <gtest/gtest.h>
#include <random>

#include "cell_sums.hpp"
#include "region.hpp"

namespace
{

const int width = 647, height = 94, stride = 659; // no multiples of a cell, nor of a vector
const int columns = width / pong::cell_size, rows = height / pong::cell_size;
const int threshold = 100; // a sum of pixels
const int samples_most = pong::CellSamples::capacity;

using Random = std::mt19937;

std::vector<uint8_t> random_pixels(Random &random)
{
	std::vector<uint8_t> pixels(static_cast<size_t>(stride * height));
	for (uint8_t &pixel : pixels)
		pixel = static_cast<uint8_t>(random() % 200);
	return pixels;
}

// Mostly as another one.
std::vector<uint8_t> changed(std::vector<uint8_t> pixels, Random &random)
{
	for (uint8_t &pixel : pixels)
		pixel = static_cast<uint8_t>(std::min<uint32_t>(255, pixel + (random() % 97 ? 0 : random() % 200)));
	return pixels;
}

pong_image image_of(const std::vector<uint8_t> &pixels)
{
	return {pixels.data(), width, height, stride};
}

int sum_one_by_one(const pong_image &image, int column, int row)
{
	int sum = 0;
	for (int v = 0; v < pong::cell_size; v++)
		for (int u = 0; u < pong::cell_size; u++)
			sum += image.pixels[(pong::cell_size * row + v) * image.stride + pong::cell_size * column + u];
	return sum;
}

// Rows of any length, some empty, some that end with the picture.
pong_region ragged_region(Random &random)
{
	pong_region region = {width, height, {}};
	for (int v = 0; v < height; v++) {
		const int a = static_cast<int>(random() % (width + 1)), b = static_cast<int>(random() % (width + 1));
		const bool empty = v / 8 % 4 == 3;
		region.rows.push_back({empty ? 0 : std::min(a, b), empty ? 0 : std::max(a, b), 8, 40});
	}
	region.rows[1].end = width;
	return region;
}

pong::Area random_area(Random &random)
{
	const int a = static_cast<int>(random() % columns), b = static_cast<int>(random() % columns);
	const int c = static_cast<int>(random() % rows), d = static_cast<int>(random() % rows);
	return {std::min(a, b), std::max(a, b) + 1, std::min(c, d), std::max(c, d) + 1};
}

// Three pictures that differ here and there.
class CellSums : public testing::Test
{
protected:
	CellSums() : region_(ragged_region(random_)), sums_(region_, 3)
	{
		sums_.set_pictures(pictures_);
	}

	int earlier(int column, int row) const
	{
		return sum_one_by_one(pictures_.earlier[0], column, row);
	}
	int older(int column, int row) const
	{
		return sum_one_by_one(pictures_.earlier[1], column, row);
	}
	int now(int column, int row) const
	{
		return sum_one_by_one(pictures_.current, column, row);
	}

	// Each strip's cells lie outside by what the pixels' sums do, in light that is so many times that of then and
	// before.
	void expect_outside(const pong::Area &area, int32_t then_gain, int32_t before_gain)
	{
		sums_.for_each_strip(area, [&](const pong::Area &strip) {
			const int row = strip.v_begin;
			const int16_t *outside = sums_.outside(strip, before_gain);
			for (int column = strip.u_begin; column < strip.u_end; column++) {
				const int one = earlier(column, row) * then_gain / pong::gain_one;
				const int other = older(column, row) * before_gain / pong::gain_one;
				const int there = now(column, row);
				EXPECT_EQ(outside[column - strip.u_begin],
					  std::max({0, there - std::max(one, other), std::min(one, other) - there}));
			}
		});
	}

	Random random_{5};
	const std::vector<uint8_t> then_ = random_pixels(random_), before_ = changed(then_, random_),
				   now_ = changed(then_, random_);
	const pong_pictures pictures_ = {image_of(now_), {image_of(then_), image_of(before_)}};
	const pong_region region_;
	pong::CellSums sums_;
};

// Every cell with a pixel of the region, and none beside the picture.
TEST_F(CellSums, StripsHoldTheRegion)
{
	std::vector<int> held(static_cast<size_t>(columns * rows));
	sums_.for_each_strip({0, columns, 0, rows}, [&](const pong::Area &strip) {
		ASSERT_EQ(strip.v_end, strip.v_begin + 1);
		ASSERT_GE(strip.u_begin, 0);
		ASSERT_LE(strip.u_end, columns);
		for (int column = strip.u_begin; column < strip.u_end; column++)
			held[static_cast<size_t>(strip.v_begin * columns + column)]++;
	});
	for (int v = 0; v < rows * pong::cell_size; v++)
		for (int u = region_.rows[static_cast<size_t>(v)].begin; u < region_.rows[static_cast<size_t>(v)].end;
		     u++)
			if (u / pong::cell_size < columns) {
				EXPECT_EQ(
					held[static_cast<size_t>(v / pong::cell_size * columns + u / pong::cell_size)],
					1);
			}
}

TEST_F(CellSums, OutsideIsWhatThePixelsAre)
{
	for (int i = 0; i < 20; i++) {
		const pong::Area area = i ? random_area(random_) : pong::Area{0, columns, 0, rows};
		sums_.set_pictures(pictures_);
		sums_.sum(area);
		expect_outside(area, pong::gain_one, pong::gain_one);
	}
}

// Nothing of what was summed is asked of pixels that are remembered.
TEST_F(CellSums, RememberedOnesAreTheSame)
{
	for (const pong_image &image : pictures_.earlier)
		sums_.remember(image);
	for (int i = 0; i < 20; i++) {
		const pong::Area area = random_area(random_);
		sums_.set_pictures(pictures_);
		sums_.sum(area);
		expect_outside(area, pong::gain_one, pong::gain_one);
	}
}

TEST_F(CellSums, EarlierOnesAreSeenInTodaysLight)
{
	const int32_t then_gain = pong::gain_one * 9 / 8, before_gain = pong::gain_one * 3 / 4;
	for (const bool remembered : {false, true}) {
		for (int i = 0; remembered && i < 2; i++)
			sums_.remember(pictures_.earlier[i]);
		const pong::Area area = random_area(random_);
		sums_.set_pictures(pictures_);
		sums_.sum(area);
		sums_.scale_earlier(area, then_gain);
		expect_outside(area, then_gain, before_gain);
	}
}

// All cells that differ, and few others: they are looked at so many at a time as `together`.
TEST_F(CellSums, DifferingIsAllThatDiffers)
{
	const int together = 16;
	const pong::Area all = {0, columns, 0, rows};
	sums_.sum(all);
	int narrowed = 0, without = 0;
	for (const int least : {threshold, 900}) {
		sums_.for_each_strip(all, [&](const pong::Area &strip) {
			const pong::Area part = sums_.differing(strip, least);
			int first = strip.u_end, last = -1;
			for (int column = strip.u_begin; column < strip.u_end; column++)
				if (std::abs(now(column, strip.v_begin) - earlier(column, strip.v_begin)) > least) {
					first = std::min(first, column);
					last = column;
				}
			ASSERT_EQ(part.empty(), last < 0);
			without += part.empty();
			if (part.empty())
				return;
			narrowed += part.u_end - part.u_begin < strip.u_end - strip.u_begin;
			EXPECT_LE(part.u_begin, first);
			EXPECT_GE(part.u_begin, strip.u_begin);
			EXPECT_GT(part.u_end, last);
			EXPECT_LE(part.u_end, strip.u_end);
			EXPECT_LE(part.u_end - part.u_begin, last + 1 - first + 2 * together);
			EXPECT_EQ(part.v_begin, strip.v_begin);
		});
	}
	EXPECT_GT(narrowed, 5);
	EXPECT_GT(without, 5);
}

// Samples are cells of the area, the same ones of all three pictures, beside the region too.
TEST_F(CellSums, SamplesAreCellsOfTheArea)
{
	for (int i = 0; i < 20; i++) {
		const pong::Area area = i ? random_area(random_) : pong::Area{0, columns, 0, rows};
		sums_.set_pictures(pictures_);
		sums_.sum(area);
		pong::CellSamples samples[2];
		sums_.sample(area, samples);
		ASSERT_EQ(samples[0].count, samples[1].count);
		ASSERT_GT(samples[0].count, 0);
		ASSERT_LE(samples[0].count, samples_most);
		for (int k = 0; k < samples[0].count; k++) {
			bool is_cell = false;
			for (int row = area.v_begin; row < area.v_end && !is_cell; row++)
				for (int column = area.u_begin; column < area.u_end && !is_cell; column++)
					is_cell = samples[0].now[k] == now(column, row) &&
						  samples[1].now[k] == now(column, row) &&
						  samples[0].then[k] == earlier(column, row) &&
						  samples[1].then[k] == older(column, row);
			EXPECT_TRUE(is_cell) << k;
		}
	}
}

} // namespace
