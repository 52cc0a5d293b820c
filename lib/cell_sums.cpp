#include "cell_sums.hpp"

#include <algorithm>
#include <cstdlib>

#include "region.hpp"
#include "vectors.hpp"

namespace pong
{

namespace
{

const int sampled_strips = 4;  // rows of cells that tell noise and gain
const int sampled_cells = 64;  // of each
const int cells_together = 16; // so many are as quickly looked at as fewer

// The columns of each row of cells that the region has.
std::vector<Area> strips_of(const pong_region &region, int columns, int rows)
{
	std::vector<Area> strips;
	for (int row = 0; row < rows; row++) {
		Area strip = {columns, 0, row, row + 1};
		for (int v = row * cell_size; v < (row + 1) * cell_size; v++) {
			const pong_region_row &pixels = region.rows[static_cast<size_t>(v)];
			if (pixels.begin == pixels.end)
				continue;
			strip.u_begin = std::min(strip.u_begin, pixels.begin / cell_size);
			strip.u_end = std::max(strip.u_end, std::min(columns, pixels.end / cell_size + 1));
		}
		strips.push_back(strip);
	}
	return strips;
}

// Rows of cells here and there.
template<class Visit> void for_each_sampled_row(const Area &cells, Visit visit)
{
	const int height = cells.v_end - cells.v_begin, strips = std::min(sampled_strips, height);
	for (int strip = 0; strip < strips; strip++)
		visit(cells.v_begin + (2 * strip + 1) * height / (2 * strips));
}

void sum_strip(const pong_image &image, const Area &strip, uint16_t *sums)
{
	sum_cells(image.pixels + strip.v_begin * cell_size * image.stride + strip.u_begin * cell_size, image.stride,
		  strip.u_end - strip.u_begin, sums);
}

} // namespace

// What lies in a row, one after the other.
static void fetch_row(const void *begin, const void *end)
{
	const int cache_line = 64; // bytes
	const char *const last = static_cast<const char *>(end) - 1;
	for (const char *at = static_cast<const char *>(begin); at < last; at += cache_line)
		__builtin_prefetch(at);
	__builtin_prefetch(last);
}

void fetch_cells(const pong_image &image, const Area &cells)
{
	for (int v = cells.v_begin * cell_size; v < cells.v_end * cell_size; v++) {
		const uint8_t *row = image.pixels + v * image.stride;
		fetch_row(row + cells.u_begin * cell_size, row + cells.u_end * cell_size);
	}
}

CellSums::CellSums(const pong_region &region, int remembered)
	: columns_(region.width / cell_size), rows_(region.height / cell_size),
	  strips_(strips_of(region, columns_, rows_)), memory_(region.width, region.height, remembered)
{
	for (auto *picture : {&now_, &then_})
		picture->resize(static_cast<size_t>(columns_ * rows_ + cells_beside));
	before_.resize(static_cast<size_t>(columns_ + cells_beside));
	outside_.resize(static_cast<size_t>(columns_ + cells_beside));
	change_.resize(static_cast<size_t>(rows_));
}

void CellSums::set_pictures(const pong_pictures &pictures)
{
	pictures_ = pictures;
	const uint16_t *const remembered = memory_.cells_of(pictures.earlier[0]);
	then_cells_ = remembered ? remembered : then_.data();
	older_cells_ = memory_.cells_of(pictures.earlier[1]);
}

void CellSums::fetch_samples(const Area &cells) const
{
	for_each_sampled_row(cells, [&](int row) { fetch_older({cells.u_begin, cells.u_end, row, row + 1}); });
}

void CellSums::fetch(const Area &cells) const
{
	fetch_cells(pictures_.current, cells);
	const uint16_t *const remembered[] = {then_cells_ == then_.data() ? nullptr : then_cells_, older_cells_};
	for (int i = 0; i < 2; i++) {
		if (!remembered[i])
			fetch_cells(pictures_.earlier[i], cells);
		for (int row = cells.v_begin; remembered[i] && row < cells.v_end; row++)
			fetch_row(&remembered[i][cell(cells.u_begin, row)], &remembered[i][cell(cells.u_end, row)]);
	}
}

void CellSums::fetch_older(const Area &strip) const
{
	if (!older_cells_)
		fetch_cells(pictures_.earlier[1], strip);
}

// A strip of one picture, then of the other: while one is summed, memory sends the next strip of the other.
void CellSums::sum(const Area &cells)
{
	const bool read_earlier = then_cells_ == then_.data();
	const auto sum_both = [&](const Area &strip) {
		const size_t first = cell(strip.u_begin, strip.v_begin);
		sum_strip(pictures_.current, strip, &now_[first]);
		if (read_earlier)
			sum_strip(pictures_.earlier[0], strip, &then_[first]);
	};
	// Compared a row later than summed: processors wait where they read otherwise what they have just written.
	Area summed = {0, 0, 0, 0};
	for_each_strip(cells, [&](const Area &strip) {
		sum_both(strip);
		change_[static_cast<size_t>(summed.v_begin)] = greatest_change(summed);
		summed = strip;
	});
	change_[static_cast<size_t>(summed.v_begin)] = greatest_change(summed);
	// Samples are taken beside the region too.
	for_each_sampled_row(cells, [&](int row) {
		const Area strip = intersect(strips_[static_cast<size_t>(row)], cells);
		if (strip.u_begin != cells.u_begin || strip.u_end != cells.u_end)
			sum_both({cells.u_begin, cells.u_end, row, row + 1});
	});
}

void CellSums::sample(const Area &cells, CellSamples samples[2])
{
	const int columns = cells.u_end - cells.u_begin, every = columns / sampled_cells + 1;
	for_each_sampled_row(cells, [&](int row) {
		const auto sample_row = [&](const uint16_t *in, int begin, uint16_t *out) {
			for (int i = 0; every == 1 && i < columns; i += together) {
				Words sums;
				load(in + i, sums);
				store(sums, out + begin + i);
			}
			for (int i = 0; every > 1 && i * every < columns; i++)
				out[begin + i] = in[i * every];
		};
		const int begin = samples[0].count;
		const size_t first = cell(cells.u_begin, row);
		for (int i = 0; i < 2; i++)
			sample_row(&now_[first], begin, samples[i].now);
		sample_row(&then_cells_[first], begin, samples[0].then);
		sample_row(older_strip({cells.u_begin, cells.u_end, row, row + 1}), begin, samples[1].then);
		for (int i = 0; i < 2; i++)
			samples[i].count = begin + (columns + every - 1) / every;
	});
}

void CellSums::scale_earlier(const Area &cells, int32_t gain)
{
	const uint16_t *const unscaled = then_cells_;
	then_cells_ = then_.data();
	for_each_strip(cells, [&](const Area &strip) {
		const size_t first = cell(strip.u_begin, strip.v_begin);
		scale_cells(&unscaled[first], strip.u_end - strip.u_begin, gain, &then_[first]);
		change_[static_cast<size_t>(strip.v_begin)] = greatest_change(strip);
	});
}

int CellSums::greatest_change(const Area &strip) const
{
	const size_t first = cell(strip.u_begin, strip.v_begin);
	return greatest_difference(&now_[first], &then_cells_[first], strip.u_end - strip.u_begin);
}

Area CellSums::differing(const Area &strip, int32_t threshold) const
{
	const int row = strip.v_begin;
	if (change_[static_cast<size_t>(row)] <= threshold)
		return {0, 0, 0, 0};
	Area part = strip;
	const auto has_more = [&] { return part.u_end - part.u_begin > cells_together; };
	const auto differs = [&](int begin) {
		return greatest_change({begin, begin + cells_together, row, row + 1}) > threshold;
	};
	while (has_more() && !differs(part.u_begin))
		part.u_begin += cells_together;
	while (has_more() && !differs(part.u_end - cells_together))
		part.u_end -= cells_together;
	return part;
}

// The cells of a part of a row of the older picture.
const uint16_t *CellSums::older_strip(const Area &strip)
{
	if (older_cells_)
		return &older_cells_[cell(strip.u_begin, strip.v_begin)];
	sum_strip(pictures_.earlier[1], strip, before_.data());
	return before_.data();
}

const int16_t *CellSums::outside(const Area &strip, int32_t older_gain)
{
	const int count = strip.u_end - strip.u_begin;
	const size_t first = cell(strip.u_begin, strip.v_begin);
	const uint16_t *before = older_strip(strip);
	if (older_gain != gain_one) {
		scale_cells(before, count, older_gain, before_.data());
		before = before_.data();
	}
	measure_outside(&now_[first], &then_cells_[first], before, count, outside_.data());
	return outside_.data();
}

} // namespace pong
