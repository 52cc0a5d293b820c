// The search in a picture for what it shows and two earlier ones don't.
//
// 1. Cells of 4 x 4 pixels are compared with the earlier picture's; where they differ by more than the noise, measured
//    in the pictures themselves, with the older one's too. Most of a picture ends here.
// 2. Cells that lie outside of both, and are neighbours but for one, are one group: a ball before a bright wall may be
//    brighter than it above and darker below.
// 3. A group is looked at close up, pixel by pixel. If what is lit there is a ball, it is one detection.
// 4. Other groups may be a ball before or beside something else that moves: the picture is searched for circles there.
//
// A lamp that flickers makes the whole picture brighter or darker: a gain, measured together with the noise.
#include <cmath>
#include <vector>

#include "blob.hpp"
#include "cell_memory.hpp"
#include "circles.hpp"
#include "conditions.hpp"
#include "fresh.hpp"
#include "region.hpp"

namespace pong
{

namespace
{

const double noise_factor = 4.5;  // a cell is lit from so many standard deviations of its noise,
const double contrast_part = 0.3; // and from this part of the least contrast of a ball
const double noise_least = 0.25;  // of a cell's mean, grey levels: pictures are rounded
const double noise_most = 4;
const double noise_learned = 0.2;             // of what one more whole picture shows
const double noise_surprising = 2.5;          // times the usual noise: that is no noise
const int reach = 2;                          // cells of a group are so close to each other, in cells
const int sampled_strips = 4;                 // rows of cells that tell noise and gain
const int sampled_cells = 64;                 // of each
const int cells_together = 8;                 // so many are as quickly summed as fewer
const int close_margin = 6;                   // a group is looked at with so many pixels around, px
const double close_noise = 1.5;               // the noise of a patch's 3 x 3 mean, over that of a cell's
const double larger = 0.8;                    // groups of this part of the smallest ball may hold one
const double fresh_noise = 4;                 // what is fresh differs by so many standard deviations of a pixel,
const double fresh_least = 6;                 // and by so many grey levels
const double fresh_seen = 12;                 // fainter groups are not seen to be fresh, grey levels
const int fresh_extent = 48;                  // nor are small ones left to it: they are searched soon, px
const int fresh_cells = 3;                    // and are so many together;
const int fresh_margin = 4;                   // a ball's centre is not farther outside of them, px
const int clutter_cells = 4;                  // noise alone lights no groups of so many cells
const double pixel_noise = cell_size / 1.414; // a pixel's noise over that of the difference of two cells' means

// A group of cells close to each other.
struct Group {
	int columns[2], rows[2]; // first and last
	double weight, weight2;  // sums of the cells' differences and of their squares
	int cells;

	double contrast() const // grey levels; the full cells count most
	{
		return weight2 / weight / cell_pixels;
	}
};

// What the pictures say of themselves.
struct Conditions {
	Gains gains;
	double noise; // standard deviation of the difference of two cells' means, grey levels
};

class DoubleDifference : public DetectMethod
{
public:
	DoubleDifference(const pong_region &region, const pong_settings &settings);

	int detect(const pong_pictures &pictures, const pong_window *window, pong_detection *found,
		   int capacity) override;

	void remember(const pong_image &image) override
	{
		memory_.remember(image);
	}

	void set_previous(const pong_image *previous) override
	{
		previous_ = previous;
	}

	bool cluttered() const override
	{
		return cluttered_;
	}

private:
	Area cells_of(const Area &pixels) const;
	Conditions measure_conditions(const pong_pictures &pictures, const Area &cells, bool windowed);
	template<class Visit> void for_each_strip(const Area &cells, Visit visit) const
	{
		for (int row = cells.v_begin; row < cells.v_end; row++) {
			const Area strip = intersect(strips_[static_cast<size_t>(row)], cells);
			if (!strip.empty())
				visit(strip);
		}
	}
	void recall(const pong_pictures &pictures);
	void fetch_ahead(const pong_pictures &pictures, const Area &cells, bool windowed) const;
	void sum_pictures(const pong_pictures &pictures, const Area &cells);
	const uint16_t *older_strip(const pong_image &older, const Area &strip);
	void light_cells(const pong_image &older, const Conditions &conditions, const Area &cells);
	int subtract(const Area &strip);
	void scale_earlier(const Area &cells, int32_t gain);
	Area differing(const Area &strip, bool scaled, int32_t threshold);
	void light_strip(const pong_image &older, int32_t gain, int32_t threshold, const Area &strip);
	size_t cell(int column, int row) const
	{
		return static_cast<size_t>(row) * static_cast<size_t>(columns_) + static_cast<size_t>(column);
	}
	Group take_group(int first);
	Area pixels_of(const Group &group, int margin) const;
	int look_at_fresh(const pong_pictures &pictures, const Conditions &conditions, pong_detection *found, int count,
			  int capacity);
	int look_at(const Group &group, const pong_pictures &pictures, const pong_window *window,
		    const Conditions &conditions, pong_detection *found, int count, int capacity);
	bool in_region(const pong_detection &ball) const;
	BallLimits limits_at(int v, const pong_window *window, const Conditions &conditions) const;

	const pong_region &region_;
	double contrast_;
	int columns_, rows_;         // of cells
	std::vector<Area> strips_;   // by row of cells: the columns of the region
	std::vector<int32_t> lit_;   // by cell, with a border: how far outside of both, 0 if not lit
	std::vector<int> lit_cells_; // places in lit_, in the order of scan
	std::vector<int> stack_;
	CellMemory memory_;
	std::vector<uint16_t> now_, then_; // cells of the current and the earlier picture,
	const uint16_t *then_cells_;       // of which the latter may be remembered, and
	const uint16_t *older_cells_;      // of the older one, null if they are not
	std::vector<int> change_;          // by row of cells, the greatest between current and earlier
	std::vector<uint16_t> before_;     // one row of the older picture
	std::vector<int16_t> to_then_, to_before_;
	std::vector<Area> differing_; // parts of rows that the earlier picture does not show
	Patch patch_;
	double noise_ = 0; // of a cell, as whole pictures have shown it, grey levels; 0: none has yet
	const pong_image *previous_ = nullptr;
	bool cluttered_ = false;
};

DoubleDifference::DoubleDifference(const pong_region &region, const pong_settings &settings)
	: region_(region), contrast_(settings.detect.contrast), columns_(region.width / cell_size),
	  rows_(region.height / cell_size), memory_(region.width, region.height, 2 * settings.detect.gap + 1),
	  patch_(region.width, region.height)
{
	const size_t cells = static_cast<size_t>(columns_ + 2 * reach) * static_cast<size_t>(rows_ + 2 * reach);
	lit_.resize(cells);
	lit_cells_.reserve(cells);
	stack_.reserve(cells);
	for (auto *picture : {&now_, &then_})
		picture->resize(static_cast<size_t>(columns_) * static_cast<size_t>(rows_));
	change_.resize(static_cast<size_t>(rows_));
	before_.resize(static_cast<size_t>(columns_));
	for (auto *row : {&to_then_, &to_before_})
		row->resize(static_cast<size_t>(columns_));
	differing_.reserve(static_cast<size_t>(rows_));
	for (int row = 0; row < rows_; row++) {
		Area strip = {columns_, 0, row, row + 1};
		for (int v = row * cell_size; v < (row + 1) * cell_size; v++) {
			const pong_region_row &pixels = region.rows[static_cast<size_t>(v)];
			if (pixels.begin == pixels.end)
				continue;
			strip.u_begin = std::min(strip.u_begin, pixels.begin / cell_size);
			strip.u_end = std::max(strip.u_end, std::min(columns_, pixels.end / cell_size + 1));
		}
		strips_.push_back(strip);
	}
}

// The cells of which an area has a pixel.
Area DoubleDifference::cells_of(const Area &pixels) const
{
	return intersect({0, columns_, 0, rows_},
			 {pixels.u_begin / cell_size, (pixels.u_end + cell_size - 1) / cell_size,
			  pixels.v_begin / cell_size, (pixels.v_end + cell_size - 1) / cell_size});
}

// Rows of cells here and there.
template<class Visit> void for_each_sampled_row(const Area &cells, Visit visit)
{
	const int height = cells.v_end - cells.v_begin, strips = std::min(sampled_strips, height);
	for (int strip = 0; strip < strips; strip++)
		visit(cells.v_begin + (2 * strip + 1) * height / (2 * strips));
}

const uint8_t *corner(const pong_image &image, int column, int row)
{
	return image.pixels + row * cell_size * image.stride + column * cell_size;
}

// Have the memory send the pixels of an area of cells, and do something else meanwhile.
void fetch(const pong_image &image, const Area &cells)
{
	const int cache_line = 64; // bytes
	const int last = (cells.u_end - cells.u_begin) * cell_size - 1;
	for (int v = cells.v_begin * cell_size; v < cells.v_end * cell_size; v++) {
		const uint8_t *pixels = image.pixels + v * image.stride + cells.u_begin * cell_size;
		for (int i = 0; i < last; i += cache_line)
			__builtin_prefetch(pixels + i);
		__builtin_prefetch(pixels + last);
	}
}

void fetch(const pong_pictures &pictures, const Area &cells)
{
	for (const pong_image *image : {&pictures.current, &pictures.earlier[0], &pictures.earlier[1]})
		fetch(*image, cells);
}

// Samples of a few strips, and what they say.
Conditions DoubleDifference::measure_conditions(const pong_pictures &pictures, const Area &cells, bool windowed)
{
	CellSamples samples[2]; // the current picture against each of the earlier ones
	const int columns = cells.u_end - cells.u_begin, every = columns / sampled_cells + 1;
	for_each_sampled_row(cells, [&](int row) {
		const auto sample = [&](const uint16_t *in, int begin, uint16_t *out) {
			for (int i = 0; i * every < columns; i++)
				out[begin + i] = in[i * every];
		};
		const int begin = samples[0].count;
		const size_t first = cell(cells.u_begin, row);
		sample(&now_[first], begin, samples[0].now);
		std::copy_n(samples[0].now + begin, sampled_cells, samples[1].now + begin);
		sample(&then_cells_[first], begin, samples[0].then);
		sample(older_strip(pictures.earlier[1], {cells.u_begin, cells.u_end, row, row + 1}), begin,
		       samples[1].then);
		samples[0].count = samples[1].count = begin + (columns + every - 1) / every;
	});
	Gains gains = {{measure_gain(samples[0]), measure_gain(samples[1])}};
	const bool flickers = gains.of[0] != gain_one || gains.of[1] != gain_one;
	if (windowed && !flickers)
		return {gains, std::max(noise_, noise_least)};
	const double noise = measure_noise(samples[0], gains.of[0]);
	if (!windowed)
		noise_ += (noise_ > 0 ? noise_learned : 1) * (std::clamp(noise, noise_least, noise_most) - noise_);
	// In a window something else that moves may be all that there is: of it comes no gain.
	else if (noise > noise_surprising * noise_)
		gains = {{gain_one, gain_one}};
	return {gains, std::max(noise_, noise_least)};
}

void DoubleDifference::recall(const pong_pictures &pictures)
{
	const uint16_t *const remembered = memory_.cells_of(pictures.earlier[0]);
	then_cells_ = remembered ? remembered : then_.data();
	older_cells_ = memory_.cells_of(pictures.earlier[1]);
}

// Have the memory send what will be read first: of windows all, of whole pictures the samples.
void DoubleDifference::fetch_ahead(const pong_pictures &pictures, const Area &cells, bool windowed) const
{
	if (windowed) {
		fetch(pictures.current, cells);
		if (then_cells_ == then_.data())
			fetch(pictures.earlier[0], cells);
	}
	if (older_cells_)
		return;
	if (windowed)
		fetch(pictures.earlier[1], cells);
	else
		for_each_sampled_row(cells, [&](int row) {
			fetch(pictures.earlier[1], {cells.u_begin, cells.u_end, row, row + 1});
		});
}

// A strip of one picture, then of the other: while one is summed, memory sends the next strip of the other. What is
// remembered is not read.
void DoubleDifference::sum_pictures(const pong_pictures &pictures, const Area &cells)
{
	const bool read_earlier = then_cells_ == then_.data();
	const auto sum_strip = [&](const pong_image &image, const Area &strip, std::vector<uint16_t> &sums) {
		sum_cells(corner(image, strip.u_begin, strip.v_begin), image.stride, strip.u_end - strip.u_begin,
			  &sums[cell(strip.u_begin, strip.v_begin)]);
	};
	for_each_strip(cells, [&](const Area &strip) {
		sum_strip(pictures.current, strip, now_);
		if (read_earlier)
			sum_strip(pictures.earlier[0], strip, then_);
		change_[static_cast<size_t>(strip.v_begin)] = subtract(strip);
	});
	// Samples are taken beside the region too.
	for_each_sampled_row(cells, [&](int row) {
		const Area strip = intersect(strips_[static_cast<size_t>(row)], cells);
		if (strip.u_begin == cells.u_begin && strip.u_end == cells.u_end)
			return;
		sum_strip(pictures.current, {cells.u_begin, cells.u_end, row, row + 1}, now_);
		if (read_earlier)
			sum_strip(pictures.earlier[0], {cells.u_begin, cells.u_end, row, row + 1}, then_);
	});
}

// The cells of a part of a row of the older picture.
const uint16_t *DoubleDifference::older_strip(const pong_image &older, const Area &strip)
{
	if (older_cells_)
		return &older_cells_[cell(strip.u_begin, strip.v_begin)];
	sum_cells(corner(older, strip.u_begin, strip.v_begin), older.stride, strip.u_end - strip.u_begin,
		  before_.data());
	return before_.data();
}

// The greatest change of a strip's cells.
int DoubleDifference::subtract(const Area &strip)
{
	const size_t first = cell(strip.u_begin, strip.v_begin);
	return subtract_cells(&now_[first], &then_cells_[first], strip.u_end - strip.u_begin, to_then_.data());
}

void DoubleDifference::scale_earlier(const Area &cells, int32_t gain)
{
	for_each_strip(cells, [&](const Area &strip) {
		const size_t first = cell(strip.u_begin, strip.v_begin);
		scale_cells(&then_cells_[first], strip.u_end - strip.u_begin, gain, &then_[first]);
	});
	then_cells_ = then_.data();
}

// The part of a strip, from its first to its last cell, that differs from the earlier picture by more than the
// threshold.
Area DoubleDifference::differing(const Area &strip, bool scaled, int32_t threshold)
{
	if (!scaled && change_[static_cast<size_t>(strip.v_begin)] <= threshold)
		return {0, 0, 0, 0};
	if (subtract(strip) <= threshold)
		return {0, 0, 0, 0};
	const auto differs = [&](int column) {
		return std::abs(to_then_[static_cast<size_t>(column - strip.u_begin)]) > threshold;
	};
	Area part = strip;
	while (!differs(part.u_begin))
		part.u_begin++;
	const int least = std::min(part.u_begin + cells_together, strip.u_end);
	while (part.u_end > least && !differs(part.u_end - 1))
		part.u_end--;
	return part;
}

// Light the cells of a part of a strip that lie outside of both earlier pictures.
void DoubleDifference::light_strip(const pong_image &older, int32_t gain, int32_t threshold, const Area &strip)
{
	const int count = strip.u_end - strip.u_begin;
	const size_t first = cell(strip.u_begin, strip.v_begin);
	const uint16_t *before = older_strip(older, strip);
	if (gain != gain_one) {
		scale_cells(before, count, gain, before_.data());
		before = before_.data();
	}
	if (subtract_cells(&now_[first], before, count, to_before_.data()) <= threshold)
		return;
	subtract_cells(&now_[first], &then_cells_[first], count, to_then_.data());
	for (int i = 0; i < count; i++) {
		const int32_t a = to_then_[static_cast<size_t>(i)], b = to_before_[static_cast<size_t>(i)];
		const int32_t beyond = (a > 0) == (b > 0) ? std::min(std::abs(a), std::abs(b)) : 0;
		if (beyond <= threshold)
			continue;
		const int place = (strip.v_begin + reach) * (columns_ + 2 * reach) + strip.u_begin + i + reach;
		lit_[static_cast<size_t>(place)] = beyond;
		lit_cells_.push_back(place);
	}
}

// The older picture is read only where the earlier one differs.
void DoubleDifference::light_cells(const pong_image &older, const Conditions &conditions, const Area &cells)
{
	for (const int place : lit_cells_)
		lit_[static_cast<size_t>(place)] = 0;
	lit_cells_.clear();
	const double least = std::max(noise_factor * conditions.noise, contrast_part * contrast_);
	const int32_t threshold = static_cast<int32_t>(cell_pixels * least);
	differing_.clear();
	const bool scaled = conditions.gains.of[0] != gain_one;
	if (scaled)
		scale_earlier(cells, conditions.gains.of[0]);
	for_each_strip(cells, [&](const Area &strip) {
		const Area part = differing(strip, scaled, threshold);
		if (part.empty())
			return;
		if (!older_cells_)
			fetch(older, part);
		differing_.push_back(part);
	});
	for (const Area &part : differing_)
		light_strip(older, conditions.gains.of[1], threshold, part);
}

// Collect the lit cells close to the first one, and take them out.
Group DoubleDifference::take_group(int first)
{
	const int stride = columns_ + 2 * reach;
	Group group = {{columns_, -1}, {rows_, -1}, 0, 0, 0};
	const auto take = [&](int place) {
		const double weight = lit_[static_cast<size_t>(place)];
		const int column = place % stride - reach, row = place / stride - reach;
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
				if (lit_[static_cast<size_t>(place + down * stride + right)])
					take(place + down * stride + right);
	}
	return group;
}

BallLimits DoubleDifference::limits_at(int v, const pong_window *window, const Conditions &conditions) const
{
	const pong_region_row &row = region_.rows[static_cast<size_t>(std::clamp(v, 0, region_.height - 1))];
	return {window ? window->size_min : row.size_min, window ? window->size_max : row.size_max, contrast_,
		close_noise * conditions.noise};
}

bool DoubleDifference::in_region(const pong_detection &ball) const
{
	const int v = static_cast<int>(std::lround(ball.v));
	if (v < 0 || v >= region_.height)
		return false;
	const pong_region_row &row = region_.rows[static_cast<size_t>(v)];
	return ball.u >= row.begin && ball.u < row.end;
}

// The pixels of a group, and some around.
Area DoubleDifference::pixels_of(const Group &group, int margin) const
{
	return intersect({0, region_.width, 0, region_.height},
			 {group.columns[0] * cell_size - margin, (group.columns[1] + 1) * cell_size + margin,
			  group.rows[0] * cell_size - margin, (group.rows[1] + 1) * cell_size + margin});
}

// Look at a group close up: one ball, or a ball beside something else.
int DoubleDifference::look_at(const Group &group, const pong_pictures &pictures, const pong_window *window,
			      const Conditions &conditions, pong_detection *found, int count, int capacity)
{
	const Area area = pixels_of(group, cell_size / 2);
	const BallLimits limits = limits_at((area.v_begin + area.v_end) / 2, window, conditions);
	const int extent = std::max(area.u_end - area.u_begin, area.v_end - area.v_begin);
	if (extent < limits.size_min / 2)
		return count;
	const Area around = pixels_of(group, close_margin);
	fetch(pictures, cells_of(around)); // the cache may hold no more what was read long ago
	patch_.fill(pictures, conditions.gains, around);
	pong_detection ball;
	if (measure_blob(patch_, area, group.contrast(), limits, &ball))
		return in_region(ball) && !is_known(ball, found, count) ? insert_detection(ball, found, count, capacity)
									: count;
	cluttered_ |= group.cells >= clutter_cells;
	const bool left_to_fresh = previous_ && !window && group.contrast() >= fresh_seen && extent > fresh_extent;
	if (extent < larger * limits.size_min || left_to_fresh)
		return count;
	return find_circles(pictures.current, patch_, area, {limits, pixel_noise * conditions.noise, window}, found,
			    count, capacity);
}

// Search what is fresh since the previous picture for circles. Takes the place of looking for them in all that is new,
// which is a lot where people move.
int DoubleDifference::look_at_fresh(const pong_pictures &pictures, const Conditions &conditions, pong_detection *found,
				    int count, int capacity)
{
	const pong_pictures latest = {pictures.current, {*previous_, *previous_}};
	const int32_t gain = gain_between(latest.current, *previous_);
	const Conditions since = {{{gain, gain}}, conditions.noise};
	const Area all = {0, columns_, 0, rows_};
	recall(latest);
	sum_pictures(latest, all);
	light_cells(*previous_, since, all);
	const int stride = columns_ + 2 * reach;
	const double noise = pixel_noise * conditions.noise, level = std::max(fresh_noise * noise, fresh_least);
	for (const int place : lit_cells_)
		lit_[static_cast<size_t>(place)] *= is_fresh_cell(
			latest.current, *previous_, gain, place % stride - reach, place / stride - reach, level);
	for (const int place : lit_cells_) {
		if (!lit_[static_cast<size_t>(place)])
			continue;
		const Group group = take_group(place);
		if (group.cells < fresh_cells)
			continue;
		const Area area = pixels_of(group, fresh_margin),
			   around = pixels_of(group, fresh_margin + close_margin);
		const BallLimits limits = limits_at((area.v_begin + area.v_end) / 2, nullptr, conditions);
		const Moved moved = follow_motion(latest.current, *previous_, around);
		patch_.fill({latest.current, {moved.image[0], moved.image[1]}}, since.gains, around);
		pong_detection ball;
		if (measure_blob(patch_, area, group.contrast(), limits, &ball) && in_region(ball))
			count = insert_detection(ball, found, count, capacity);
		patch_.fill(latest, since.gains, around);
		count = find_circles(pictures.current, patch_, area, {limits, noise, nullptr}, found, count, capacity);
	}
	return count;
}

int DoubleDifference::detect(const pong_pictures &pictures, const pong_window *window, pong_detection *found,
			     int capacity)
{
	const Area cells = cells_of(searched_area(region_.width, region_.height, window));
	if (cells.empty())
		return 0;
	recall(pictures);
	fetch_ahead(pictures, cells, window != nullptr);
	sum_pictures(pictures, cells);
	const Conditions conditions = measure_conditions(pictures, cells, window != nullptr);
	light_cells(pictures.earlier[1], conditions, cells);
	cluttered_ = false;
	int count = 0;
	for (const int place : lit_cells_)
		if (lit_[static_cast<size_t>(place)])
			count = look_at(take_group(place), pictures, window, conditions, found, count, capacity);
	if (cluttered_ && previous_ && !window)
		count = look_at_fresh(pictures, conditions, found, count, capacity);
	return count;
}

} // namespace

std::unique_ptr<DetectMethod> make_double_difference(const pong_region &region, const pong_settings &settings)
{
	return std::make_unique<DoubleDifference>(region, settings);
}

} // namespace pong
