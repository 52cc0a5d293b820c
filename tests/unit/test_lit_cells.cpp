// Which cells are lit, and their groups, against every cell looked at by itself.
#include <gtest/gtest.h>
#include <random>
#include <set>

#include "lit_cells.hpp"
#include "region.hpp"

namespace
{

const int columns = 37, rows = 23; // cells
const int width = pong::cell_size * columns + 3, height = pong::cell_size * rows + 2;
const int threshold = 200; // a sum of pixels
const int level = 100;     // of the room, grey levels

struct CellPicture {
	std::vector<uint8_t> pixels = std::vector<uint8_t>(width * height, level);

	// The cells' means differ from the room by so much.
	void set(int column, int row, int difference)
	{
		for (int v = 0; v < pong::cell_size; v++)
			for (int u = 0; u < pong::cell_size; u++)
				pixels[static_cast<size_t>((pong::cell_size * row + v) * width +
							   pong::cell_size * column + u)] =
					static_cast<uint8_t>(level + difference);
	}

	int at(int column, int row) const
	{
		return pong::cell_pixels * pixels[static_cast<size_t>(pong::cell_size * (row * width + column))];
	}

	pong_image image() const
	{
		return {pixels.data(), width, height, width};
	}
};

using Place = std::pair<int, int>; // column, row
using Group = std::set<Place>;

class LitCells : public testing::Test
{
protected:
	LitCells() : region_{width, height, std::vector<pong_region_row>(height, {0, width, 8, 40})}
	{
	}

	void light(const pong::Gains &gains = {{pong::gain_one, pong::gain_one}})
	{
		const pong::Area all = {0, columns, 0, rows};
		sums_.set_pictures({now_.image(), {then_.image(), before_.image()}});
		sums_.sum(all);
		lit_.light(sums_, all, gains, threshold);
	}

	std::vector<pong::CellGroup> groups()
	{
		std::vector<pong::CellGroup> found;
		lit_.for_each_group([&](const pong::CellGroup &group) { found.push_back(group); });
		return found;
	}

	// How far a cell lies outside of what both earlier pictures show.
	int beyond(int column, int row) const
	{
		const int now = now_.at(column, row), then = then_.at(column, row), before = before_.at(column, row);
		return std::max({0, now - std::max(then, before), std::min(then, before) - now});
	}

	// Cells that are lit, as groups whose cells are two apart at most.
	std::vector<Group> groups_one_by_one() const
	{
		std::vector<Group> all;
		for (int row = 0; row < rows; row++)
			for (int column = 0; column < columns; column++)
				if (beyond(column, row) > threshold)
					add({column, row}, &all);
		return all;
	}

	static void add(const Place &place, std::vector<Group> *all)
	{
		Group joined = {place};
		for (size_t i = all->size(); i-- > 0;)
			if (std::any_of((*all)[i].begin(), (*all)[i].end(), [&](const Place &other) {
				    return std::abs(other.first - place.first) <= 2 &&
					   std::abs(other.second - place.second) <= 2;
			    })) {
				joined.insert((*all)[i].begin(), (*all)[i].end());
				all->erase(all->begin() + static_cast<ptrdiff_t>(i));
			}
		all->push_back(joined);
	}

	void expect_group(const pong::CellGroup &found, const Group &expected) const
	{
		double weight = 0, weight2 = 0;
		int left = columns, right = -1;
		for (const Place &place : expected) {
			const double by = beyond(place.first, place.second);
			weight += by;
			weight2 += by * by;
			left = std::min(left, place.first);
			right = std::max(right, place.first);
		}
		EXPECT_EQ(found.cells, static_cast<int>(expected.size()));
		EXPECT_EQ(found.columns[0], left);
		EXPECT_EQ(found.columns[1], right);
		EXPECT_DOUBLE_EQ(found.contrast(), weight2 / weight / pong::cell_pixels);
	}

	CellPicture now_, then_, before_;
	const pong_region region_;
	pong::CellSums sums_{region_, 3};
	pong::LitCells lit_{columns, rows};
};

TEST_F(LitCells, AreThoseOutsideOfBothEarlierPictures)
{
	now_.set(5, 5, 40);   // brighter than both
	now_.set(12, 5, -40); // darker than both
	now_.set(20, 5, 12);  // by too little
	now_.set(5, 15, 40);  // as one of them
	before_.set(5, 15, 40);
	then_.set(12, 15, 40); // between them: where a ball has been
	before_.set(12, 15, -40);
	then_.set(20, 15, 40); // gone from one
	light();
	const std::vector<pong::CellGroup> found = groups();
	ASSERT_EQ(found.size(), 2u);
	EXPECT_EQ(found[0].columns[0], 5);
	EXPECT_EQ(found[1].columns[0], 12);
	for (const pong::CellGroup &group : found) {
		EXPECT_EQ(group.rows[0], 5);
		EXPECT_EQ(group.contrast(), 40);
	}
}

// Close ones are one group, across a gap of one, also at the picture's borders.
TEST_F(LitCells, GroupsAreThoseOfEachCellByItself)
{
	std::mt19937 random(4);
	for (int round = 0; round < 10; round++) {
		now_ = then_ = before_ = {};
		for (int i = 0; i < 60; i++) {
			const int column = static_cast<int>(random() % columns),
				  row = static_cast<int>(random() % rows);
			const int by = static_cast<int>(random() % 120) - 60;
			now_.set(column, row, by);
			if (i % 3 == 0)
				(i % 2 ? then_ : before_).set(column, row, by / 2);
		}
		for (const int corner : {0, columns - 1})
			now_.set(corner, corner ? rows - 1 : 0, 50);
		light();
		std::vector<Group> expected = groups_one_by_one();
		const std::vector<pong::CellGroup> found = groups();
		ASSERT_EQ(found.size(), expected.size());
		// In the order of their first cells in a scan.
		const auto first = [](const Group &group) {
			Place least = *group.begin();
			for (const Place &place : group)
				if (std::make_pair(place.second, place.first) <
				    std::make_pair(least.second, least.first))
					least = place;
			return std::make_pair(least.second, least.first);
		};
		std::sort(expected.begin(), expected.end(),
			  [&](const Group &a, const Group &b) { return first(a) < first(b); });
		for (size_t i = 0; i < found.size(); i++)
			expect_group(found[i], expected[i]);
	}
}

TEST_F(LitCells, AreTakenOutOnce)
{
	now_.set(5, 5, 40);
	light();
	EXPECT_EQ(groups().size(), 1u);
	EXPECT_EQ(groups().size(), 0u);
	light();
	now_.set(5, 5, 0);
	now_.set(7, 5, 40);
	light(); // no more of the cell that was lit then
	const std::vector<pong::CellGroup> found = groups();
	ASSERT_EQ(found.size(), 1u);
	EXPECT_EQ(found[0].cells, 1);
}

TEST_F(LitCells, OnlyThoseKeptAreLeft)
{
	for (int column = 0; column < columns; column++)
		now_.set(column, 7, 40);
	light();
	lit_.keep([](int column, int row) { return row == 7 && column >= 10 && column < 14; });
	const std::vector<pong::CellGroup> found = groups();
	ASSERT_EQ(found.size(), 1u);
	EXPECT_EQ(found[0].cells, 4);
	EXPECT_EQ(found[0].columns[0], 10);
	EXPECT_EQ(found[0].columns[1], 13);
}

// All is a quarter brighter than in one earlier picture, and less than half as bright as in the other.
TEST_F(LitCells, NoneBecauseOfALampThatFlickers)
{
	for (uint8_t &pixel : then_.pixels)
		pixel = 80;
	for (uint8_t &pixel : before_.pixels)
		pixel = 200;
	now_.set(5, 5, 40);
	now_.set(5, 15, -40);
	light({{pong::gain_one * 5 / 4, pong::gain_one / 2}});
	const std::vector<pong::CellGroup> found = groups();
	ASSERT_EQ(found.size(), 2u);
	for (const pong::CellGroup &group : found) {
		EXPECT_EQ(group.cells, 1);
		EXPECT_EQ(group.contrast(), 40);
	}
}

} // namespace
