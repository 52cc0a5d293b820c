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
	int cells;
	int32_t weight;  // sum of the cells' differences, sums of pixels,
	int64_t weight2; // and of their squares

	double contrast() const // grey levels; the full cells count most
	{
		return static_cast<double>(weight2) / weight / cell_pixels;
	}

	void add(const CellGroup &other)
	{
		columns[0] = std::min(columns[0], other.columns[0]);
		columns[1] = std::max(columns[1], other.columns[1]);
		rows[0] = std::min(rows[0], other.rows[0]);
		rows[1] = std::max(rows[1], other.rows[1]);
		weight += other.weight;
		weight2 += other.weight2;
		cells += other.cells;
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
		const auto goes = [&](const Lit &lit) { return !is_kept(lit.column, lit.row); };
		lit_.erase(std::remove_if(lit_.begin(), lit_.end(), goes), lit_.end());
	}

	// Take the groups out, in the order of scan.
	template<class Visit> void for_each_group(Visit visit)
	{
		make_groups();
		lit_.clear();
		for (const Run &run : runs_)
			if (run.first == &run)
				visit(run.group);
	}

private:
	static const int reach = 2; // cells of a group are so close to each other, in cells

	struct Lit {
		int column, row;
		int32_t beyond; // how far outside of both earlier pictures, a sum of pixels
	};

	// Lit cells close to each other in one row. Of runs that are close to each other all point, one by way of the
	// other, at the first, which gathers the group.
	struct Run {
		Run *first;
		CellGroup group; // of this run alone, until all are joined

		int begin() const
		{
			return group.columns[0];
		}
		int end() const // the last one
		{
			return group.columns[1];
		}
		int row() const
		{
			return group.rows[0];
		}
	};

	void light_strip(CellSums &sums, const Area &strip, int32_t older_gain, int32_t threshold);
	void make_runs();
	void make_groups();

	std::vector<Lit> lit_; // in the order of scan
	std::vector<Run> runs_;
	std::vector<Area> differing_; // parts of rows that the earlier picture does not show
};

} // namespace pong
