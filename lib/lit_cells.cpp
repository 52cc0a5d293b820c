#include "lit_cells.hpp"

namespace pong
{

LitCells::LitCells(int columns, int rows)
{
	const size_t cells = static_cast<size_t>(columns) * static_cast<size_t>(rows);
	lit_.reserve(cells);
	runs_.reserve(cells);
	differing_.reserve(static_cast<size_t>(rows));
}

// Light the cells of a part of a row.
void LitCells::light_strip(CellSums &sums, const Area &strip, int32_t older_gain, int32_t threshold)
{
	const int16_t *outside = sums.outside(strip, older_gain);
	for (int column = strip.u_begin; column < strip.u_end; column++, outside++)
		if (*outside > threshold)
			lit_.push_back({column, strip.v_begin, *outside});
}

// The older picture is read only where the earlier one differs.
void LitCells::light(CellSums &sums, const Area &cells, const Gains &gains, int32_t threshold)
{
	lit_.clear();
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

void LitCells::make_runs()
{
	runs_.clear();
	Run *run = nullptr;
	for (const Lit &lit : lit_) {
		if (!run || run->row() != lit.row || lit.column > run->end() + reach) {
			runs_.push_back({nullptr, {{lit.column, lit.column}, {lit.row, lit.row}, 0, 0, 0}});
			run = &runs_.back();
		}
		run->group.columns[1] = lit.column;
		run->group.cells++;
		run->group.weight += lit.beyond;
		run->group.weight2 += lit.beyond * lit.beyond;
	}
}

void LitCells::make_groups()
{
	make_runs();
	const auto first_of = [](Run *run) {
		while (run->first != run)
			run = run->first = run->first->first;
		return run;
	};
	Run *above = runs_.data(); // no run before this one is close enough
	for (Run &run : runs_) {
		run.first = &run;
		while (above->row() < run.row() - reach)
			above++;
		for (Run *other = above; other->row() < run.row(); other++)
			if (other->begin() <= run.end() + reach && run.begin() <= other->end() + reach) {
				Run *const a = first_of(&run), *const b = first_of(other);
				std::max(a, b)->first = std::min(a, b);
			}
	}
	for (Run &run : runs_)
		if (Run *const first = first_of(&run); first != &run)
			first->group.add(run.group);
}

} // namespace pong
