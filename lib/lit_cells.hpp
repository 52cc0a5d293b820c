// The cells that a picture shows otherwise than two earlier ones, and groups of them.
#pragma once

#include <algorithm>
#include <vector>

#include "cell_sums.hpp"
#include "patch.hpp"

namespace pong
{

// A group of cells close to each other.
struct CellGroup {
	int columns[2], rows[2]; // first and last
	double weight, weight2;  // sums of the cells' differences and of their squares
	int cells;

	double contrast() const // grey levels; the full cells count most
	{
		return weight2 / weight / cell_pixels;
	}
};

class LitCells
{
public:
	LitCells(int columns, int rows);

	// Light the cells that lie outside of both earlier pictures by more than the threshold, a sum of pixels; no
	// others.
	void light(CellSums &sums, const Area &cells, const Gains &gains, int32_t threshold);

	// Leave only those lit of which `is_kept(column, row)`.
	template<class Kept> void keep(Kept is_kept)
	{
		for (const int place : lit_cells_)
			if (!is_kept(place % stride() - reach, place / stride() - reach))
				lit_[static_cast<size_t>(place)] = 0;
	}

	// Take the groups out, in the order of scan.
	template<class Visit> void for_each_group(Visit visit)
	{
		for (const int place : lit_cells_)
			if (lit_[static_cast<size_t>(place)])
				visit(take_group(place));
	}

private:
	static const int reach = 2; // cells of a group are so close to each other, in cells

	int stride() const
	{
		return columns_ + 2 * reach;
	}
	void light_strip(CellSums &sums, const Area &strip, int32_t gain, int32_t threshold);
	CellGroup take_group(int first);

	int columns_, rows_;
	std::vector<int32_t> lit_;   // by cell, with a border: how far outside of both, 0 if not lit
	std::vector<int> lit_cells_; // places in lit_, in the order of scan
	std::vector<int> stack_;
	std::vector<Area> differing_; // parts of rows that the earlier picture does not show
};

} // namespace pong
