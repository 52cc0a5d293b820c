// A picture and two earlier ones in cells, and the cells' differences. What is remembered of the earlier ones is not
// read again, and the older one is only read where it is asked for.
#pragma once

#include <cstddef>
#include <vector>

#include "cell_memory.hpp"
#include "conditions.hpp"
#include "detector.hpp"

namespace pong
{

// Have the memory send the pixels of an area of cells, and do something else meanwhile.
void fetch_cells(const pong_image &image, const Area &cells);

class CellSums
{
public:
	// There is memory for so many pictures that are remembered.
	CellSums(const pong_region &region, int remembered);

	int columns() const
	{
		return columns_;
	}
	int rows() const
	{
		return rows_;
	}

	void remember(const pong_image &image)
	{
		memory_.remember(image);
	}

	// Tell the pictures, which must stay while they are looked at; then sum an area's cells of the current and the
	// earlier one.
	void set_pictures(const pong_pictures &pictures);
	void sum(const Area &cells);

	// Have the memory send what will be read first of whole pictures: the samples.
	void fetch_samples(const Area &cells) const;

	// The same of what will be read of an area.
	void fetch(const Area &cells) const;

	// The current picture against each of the earlier ones, here and there in the area that was summed.
	void sample(const Area &cells, CellSamples samples[2]);

	// See the earlier picture in today's light.
	void scale_earlier(const Area &cells, int32_t gain);

	// Parts of rows of an area that lie in the region.
	template<class Visit> void for_each_strip(const Area &cells, Visit visit) const
	{
		for (int row = cells.v_begin; row < cells.v_end; row++) {
			const Area strip = intersect(strips_[static_cast<size_t>(row)], cells);
			if (!strip.empty())
				visit(strip);
		}
	}

	// A part of a strip with all cells that differ from the earlier picture by more than the threshold, and few
	// others beside them.
	Area differing(const Area &strip, int32_t threshold) const;

	// Have the memory send a strip of the older picture, unless it is remembered.
	void fetch_older(const Area &strip) const;

	// How far each cell of a strip lies outside of what the earlier picture and the older one, in today's light,
	// show.
	const int16_t *outside(const Area &strip, int32_t older_gain);

private:
	size_t cell(int column, int row) const
	{
		return static_cast<size_t>(row) * static_cast<size_t>(columns_) + static_cast<size_t>(column);
	}
	int greatest_change(const Area &strip) const;
	const uint16_t *older_strip(const Area &strip);

	int columns_, rows_;
	std::vector<Area> strips_; // by row of cells: the columns of the region
	CellMemory memory_;
	pong_pictures pictures_ = {};
	std::vector<uint16_t> now_, then_;      // cells of the current and the earlier picture,
	const uint16_t *then_cells_ = nullptr;  // of which the latter may be remembered, and
	const uint16_t *older_cells_ = nullptr; // of the older one, null if they are not
	std::vector<uint16_t> before_;          // one row of the older picture
	std::vector<int> change_;               // by row of cells, the greatest between current and earlier
	std::vector<int16_t> outside_;          // of one row
};

} // namespace pong
