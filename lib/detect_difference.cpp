// The paper's detection (section 4.2): the difference to one earlier picture becomes binary by its own mean, and is
// scanned for the five points of a ball of the sizes that the region, or a window, allows in a row. What the points
// find is then measured: contrast, centre and size come from all of its pixels.
#include <cmath>
#include <cstdlib>
#include <vector>

#include "detector.hpp"
#include "five_points.hpp"
#include "region.hpp"

namespace pong
{

namespace
{

const size_t hits_capacity = 4096;

// A hit of the five points is a ball only if most of its pixels agree.
const double ball_level = 0.2; // of the contrast: the shaded side of a ball belongs to it
const double disc_lit_needed = 0.75;
const double ring_lit_allowed = 0.25;
const double ring_distance = 2;    // from the outline, beyond 1.3 radii, px
const double size_tolerance = 1.3; // between N and the size that is measured

class Difference : public DetectMethod
{
public:
	Difference(const pong_region &region, const pong_settings &settings)
		: region_(region), contrast_(settings.detect.contrast), sizes_(five_points_of(region)),
		  difference_(static_cast<size_t>(region.width) * static_cast<size_t>(region.height)),
		  binary_(difference_.size())
	{
		hits_.reserve(hits_capacity);
	}

	int detect(const pong_pictures &pictures, const pong_window *window, pong_detection *found,
		   int capacity) override
	{
		const Area area = searched_area(region_.width, region_.height, window);
		make_binary(fill_difference(pictures, area), area);
		scan(area, window);
		return measure_hits(area, found, capacity);
	}

private:
	size_t row_of(int v) const
	{
		return static_cast<size_t>(v) * static_cast<size_t>(region_.width);
	}

	int fill_difference(const pong_pictures &pictures, const Area &area);
	void make_binary(int threshold, const Area &area);
	void scan(const Area &area, const pong_window *window);
	void try_sizes(const Area &area, const FivePointsRange &sizes, int u, int v);
	bool measure(const Area &area, pong_detection &hit) const;
	int measure_hits(const Area &area, pong_detection *found, int capacity) const;

	const pong_region &region_;
	double contrast_;
	std::vector<FivePoints> sizes_;
	std::vector<uint8_t> difference_; // how much brighter a pixel became; the picture's size
	std::vector<uint8_t> binary_;     // 1 where the difference exceeds the threshold
	std::vector<pong_detection> hits_;
};

// Fill the difference inside of the area, as far as pixels became brighter: where the ball was in the earlier picture
// is no ball now. Returns the mean of the absolute difference.
int Difference::fill_difference(const pong_pictures &pictures, const Area &area)
{
	const pong_image &current = pictures.current, &earlier = pictures.earlier[0];
	int64_t sum = 0;
	for (int v = area.v_begin; v < area.v_end; v++) {
		const uint8_t *now = current.pixels + v * current.stride;
		const uint8_t *then = earlier.pixels + v * earlier.stride;
		uint8_t *difference = &difference_[row_of(v)];
		int row_sum = 0;
		for (int u = area.u_begin; u < area.u_end; u++) {
			row_sum += std::abs(now[u] - then[u]);
			difference[u] = now[u] > then[u] ? static_cast<uint8_t>(now[u] - then[u]) : 0;
		}
		sum += row_sum;
	}
	const int64_t pixels = static_cast<int64_t>(area.u_end - area.u_begin) * (area.v_end - area.v_begin);
	return static_cast<int>(sum / pixels);
}

// The paper's threshold is that mean.
void Difference::make_binary(int threshold, const Area &area)
{
	for (int v = area.v_begin; v < area.v_end; v++) {
		const uint8_t *difference = &difference_[row_of(v)];
		uint8_t *binary = &binary_[row_of(v)];
		for (int u = area.u_begin; u < area.u_end; u++)
			binary[u] = difference[u] > threshold;
	}
}

// Scan for upper left boundary points, and try the sizes there.
void Difference::scan(const Area &area, const pong_window *window)
{
	hits_.clear();
	for (int v = area.v_begin; v < area.v_end; v++) {
		const pong_region_row row = region_.rows[static_cast<size_t>(v)];
		const FivePointsRange sizes = sizes_between(sizes_, window ? window->size_min : row.size_min,
							    window ? window->size_max : row.size_max);
		const int u_begin = std::max(row.begin, area.u_begin), u_end = std::min(row.end, area.u_end);
		const uint8_t *binary = &binary_[row_of(v)];
		for (int u = u_begin; u < u_end; u++)
			if (binary[u])
				try_sizes(area, sizes, u, v);
	}
}

void Difference::try_sizes(const Area &area, const FivePointsRange &sizes, int u, int v)
{
	const auto lit = [&](int x, int y) {
		return area.contains(x, y) && binary_[row_of(y) + static_cast<size_t>(x)];
	};
	for (const FivePoints &points : sizes)
		if (match(points, u, v, lit) && hits_.size() < hits_capacity)
			hits_.push_back({static_cast<double>(u + points.centre.u),
					 static_cast<double>(v + points.centre.v), points.size, 0});
}

// Measure a hit: the contrast between its inside and a ring around it, then centre and size of all that is brighter
// than a part of that. Returns false where it is not a ball after all.
bool Difference::measure(const Area &area, pong_detection &hit) const
{
	const double radius = hit.size / 2, ring = 1.3 * radius + ring_distance, out = ring + 2;
	const int reach = static_cast<int>(std::ceil(out));
	const int u0 = static_cast<int>(std::lround(hit.u)), v0 = static_cast<int>(std::lround(hit.v));
	const Area box = intersect(area, {u0 - reach, u0 + reach + 1, v0 - reach, v0 + reach + 1});
	const auto for_each_pixel = [&](auto &&visit) {
		for (int v = box.v_begin; v < box.v_end; v++)
			for (int u = box.u_begin; u < box.u_end; u++)
				visit(u, v, (u - hit.u) * (u - hit.u) + (v - hit.v) * (v - hit.v),
				      difference_[row_of(v) + static_cast<size_t>(u)]);
	};
	double core = 0, core_count = 0, around = 0, around_count = 0;
	for_each_pixel([&](int, int, double distance2, double difference) {
		if (distance2 < 0.64 * radius * radius) {
			core += difference;
			core_count++;
		} else if (distance2 > ring * ring && distance2 < out * out) {
			around += difference;
			around_count++;
		}
	});
	if (core_count == 0 || around_count == 0)
		return false;
	hit.contrast = core / core_count - around / around_count;
	if (hit.contrast < contrast_)
		return false;
	const double level = around / around_count + ball_level * hit.contrast;
	double count = 0, sum_u = 0, sum_v = 0, core_lit = 0, ring_lit = 0;
	for_each_pixel([&](int u, int v, double distance2, double difference) {
		if (difference < level)
			return;
		core_lit += distance2 < 0.64 * radius * radius;
		if (distance2 > ring * ring) {
			ring_lit += distance2 < out * out;
			return;
		}
		count++;
		sum_u += u;
		sum_v += v;
	});
	if (core_lit < disc_lit_needed * core_count || ring_lit > ring_lit_allowed * around_count)
		return false;
	const double size = 2 * std::sqrt(count / M_PI);
	if (size > size_tolerance * hit.size || hit.size > size_tolerance * size)
		return false;
	hit.u = sum_u / count;
	hit.v = sum_v / count;
	hit.size = size;
	return true;
}

// Many hits tell of one ball: the first that measures well stands for all. Measured twice, for the hit's centre and
// size are only as good as the five points.
int Difference::measure_hits(const Area &area, pong_detection *found, int capacity) const
{
	int count = 0;
	for (pong_detection hit : hits_) {
		const bool known = std::any_of(found, found + count, [&](const pong_detection &ball) {
			return std::hypot(ball.u - hit.u, ball.v - hit.v) < std::max(ball.size, hit.size) / 2;
		});
		if (!known && measure(area, hit) && measure(area, hit))
			count = insert_detection(hit, found, count, capacity);
	}
	return count;
}

} // namespace

std::unique_ptr<DetectMethod> make_difference(const pong_region &region, const pong_settings &settings)
{
	return std::make_unique<Difference>(region, settings);
}

} // namespace pong
