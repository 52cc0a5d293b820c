#include "lit_cells.hpp"

#include <cstdlib>

namespace pong
{

LitCells::LitCells(int columns, int rows) : columns_(columns), rows_(rows)
{
	const size_t cells = static_cast<size_t>(stride()) * static_cast<size_t>(rows + 2 * reach);
	lit_.resize(cells);
	lit_cells_.reserve(cells);
	stack_.reserve(cells);
	differing_.reserve(static_cast<size_t>(rows));
}

// Light the cells of a part of a row.
void LitCells::light_strip(CellSums &sums, const Area &strip, int32_t gain, int32_t threshold)
{
	const int16_t *to_before = sums.change_to_older(strip, gain, threshold);
	if (!to_before)
		return;
	const int16_t *to_then = sums.change_to_earlier(strip);
	const int count = strip.u_end - strip.u_begin;
	for (int i = 0; i < count; i++) {
		const int32_t a = to_then[i], b = to_before[i];
		const int32_t beyond = (a > 0) == (b > 0) ? std::min(std::abs(a), std::abs(b)) : 0;
		if (beyond <= threshold)
			continue;
		const int place = (strip.v_begin + reach) * stride() + strip.u_begin + i + reach;
		lit_[static_cast<size_t>(place)] = beyond;
		lit_cells_.push_back(place);
	}
}

// The older picture is read only where the earlier one differs.
void LitCells::light(CellSums &sums, const Area &cells, const Gains &gains, int32_t threshold)
{
	for (const int place : lit_cells_)
		lit_[static_cast<size_t>(place)] = 0;
	lit_cells_.clear();
	differing_.clear();
	if (gains.of[0] != gain_one)
		sums.scale_earlier(cells, gains.of[0]);
	sums.for_each_strip(cells, [&](const Area &strip) {
		const Area part = sums.differing(strip, threshold);
		if (part.empty())
			return;
		sums.fetch_older(part);
		differing_.push_back(part);
	});
	for (const Area &part : differing_)
		light_strip(sums, part, gains.of[1], threshold);
}

// Collect the lit cells close to the first one, and take them out.
CellGroup LitCells::take_group(int first)
{
	CellGroup group = {{columns_, -1}, {rows_, -1}, 0, 0, 0};
	const auto take = [&](int place) {
		const double weight = lit_[static_cast<size_t>(place)];
		const int column = place % stride() - reach, row = place / stride() - reach;
		lit_[static_cast<size_t>(place)] = 0;
		group.columns[0] = std::min(group.columns[0], column);
		group.columns[1] = std::max(group.columns[1], column);
		group.rows[0] = std::min(group.rows[0], row);
		group.rows[1] = std::max(group.rows[1], row);
		group.weight += weight;
		group.weight2 += weight * weight;
		group.cells++;
		stack_.push_back(place);
	};
	take(first);
	while (!stack_.empty()) {
		const int place = stack_.back();
		stack_.pop_back();
		for (int down = -reach; down <= reach; down++)
			for (int right = -reach; right <= reach; right++)
				if (lit_[static_cast<size_t>(place + down * stride() + right)])
					take(place + down * stride() + right);
	}
	return group;
}

} // namespace pong
