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
#include "cell_sums.hpp"
#include "circles.hpp"
#include "conditions.hpp"
#include "fresh.hpp"
#include "lit_cells.hpp"
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
		sums_.remember(image);
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
	void fetch(const pong_pictures &pictures, const pong_window &window) const;
	Conditions measure_conditions(const Area &cells, bool windowed);
	int32_t threshold(const Conditions &conditions) const;
	Area pixels_of(const CellGroup &group, int margin) const;
	int look_at_fresh(const pong_pictures &pictures, const Conditions &conditions, pong_detection *found, int count,
			  int capacity);
	int look_at(const CellGroup &group, const pong_pictures &pictures, const pong_window *window,
		    const Conditions &conditions, pong_detection *found, int count, int capacity);
	bool in_region(const pong_detection &ball) const;
	BallLimits limits_at(int v, const pong_window *window, const Conditions &conditions) const;

	const pong_region &region_;
	double contrast_;
	CellSums sums_;
	LitCells lit_;
	Patch patch_;
	double noise_ = 0; // of a cell, as whole pictures have shown it, grey levels; 0: none has yet
	const pong_image *previous_ = nullptr;
	bool cluttered_ = false;
};

DoubleDifference::DoubleDifference(const pong_region &region, const pong_settings &settings)
	: region_(region), contrast_(settings.detect.contrast), sums_(region, 2 * settings.detect.gap + 1),
	  lit_(sums_.columns(), sums_.rows()), patch_(region.width, region.height)
{
}

// The cells of which an area has a pixel.
Area DoubleDifference::cells_of(const Area &pixels) const
{
	return intersect({0, sums_.columns(), 0, sums_.rows()},
			 {pixels.u_begin / cell_size, (pixels.u_end + cell_size - 1) / cell_size,
			  pixels.v_begin / cell_size, (pixels.v_end + cell_size - 1) / cell_size});
}

// Samples of a few strips, and what they say.
Conditions DoubleDifference::measure_conditions(const Area &cells, bool windowed)
{
	CellSamples samples[2];
	sums_.sample(cells, samples);
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

// A sum of pixels.
int32_t DoubleDifference::threshold(const Conditions &conditions) const
{
	const double least = std::max(noise_factor * conditions.noise, contrast_part * contrast_);
	return static_cast<int32_t>(cell_pixels * least);
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
Area DoubleDifference::pixels_of(const CellGroup &group, int margin) const
{
	return intersect({0, region_.width, 0, region_.height},
			 {group.columns[0] * cell_size - margin, (group.columns[1] + 1) * cell_size + margin,
			  group.rows[0] * cell_size - margin, (group.rows[1] + 1) * cell_size + margin});
}

// Look at a group close up: one ball, or a ball beside something else.
int DoubleDifference::look_at(const CellGroup &group, const pong_pictures &pictures, const pong_window *window,
			      const Conditions &conditions, pong_detection *found, int count, int capacity)
{
	const Area area = pixels_of(group, cell_size / 2);
	const BallLimits limits = limits_at((area.v_begin + area.v_end) / 2, window, conditions);
	const int extent = std::max(area.u_end - area.u_begin, area.v_end - area.v_begin);
	if (extent < limits.size_min / 2)
		return count;
	const Area around = pixels_of(group, close_margin);
	if (!window) // whose pixels were fetched
		for (const pong_image *image : {&pictures.current, &pictures.earlier[0], &pictures.earlier[1]})
			fetch_cells(*image, cells_of(around)); // the cache may hold no more what was read long ago
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
	const Area all = {0, sums_.columns(), 0, sums_.rows()};
	sums_.set_pictures(latest);
	sums_.sum(all);
	lit_.light(sums_, all, since.gains, threshold(since));
	const double noise = pixel_noise * conditions.noise, level = std::max(fresh_noise * noise, fresh_least);
	lit_.keep([&](int column, int row) {
		return is_fresh_cell(latest.current, *previous_, gain, column, row, level);
	});
	lit_.for_each_group([&](const CellGroup &group) {
		if (group.cells < fresh_cells)
			return;
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
	});
	return count;
}

// The ball is where the window's middle is, most likely: there the earlier pictures will be looked at close up.
void DoubleDifference::fetch(const pong_pictures &pictures, const pong_window &window) const
{
	sums_.fetch(cells_of(searched_area(region_.width, region_.height, &window)));
	const int size = static_cast<int>(window.size_max) + 2 * (close_margin + cell_size);
	const pong_window middle = {
		window.u + (window.width - size) / 2, window.v + (window.height - size) / 2, size, size, 0, 0};
	const Area cells = cells_of(searched_area(region_.width, region_.height, &middle));
	for (const pong_image &earlier : pictures.earlier)
		fetch_cells(earlier, cells);
}

int DoubleDifference::detect(const pong_pictures &pictures, const pong_window *window, pong_detection *found,
			     int capacity)
{
	const Area cells = cells_of(searched_area(region_.width, region_.height, window));
	if (cells.empty())
		return 0;
	sums_.set_pictures(pictures);
	if (!window)
		sums_.fetch_samples(cells);
	else
		fetch(pictures, *window);
	sums_.sum(cells);
	const Conditions conditions = measure_conditions(cells, window != nullptr);
	lit_.light(sums_, cells, conditions.gains, threshold(conditions));
	cluttered_ = false;
	int count = 0;
	lit_.for_each_group([&](const CellGroup &group) {
		count = look_at(group, pictures, window, conditions, found, count, capacity);
	});
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
