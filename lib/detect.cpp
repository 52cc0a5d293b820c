// Five-point detection (paper, section 4.2 and Fig. 5). The difference to an earlier picture becomes binary by its own
// mean. A ball of size N shows as five lit points: its upper left boundary point, where the scan meets it first, the
// other three diagonal ones, and the centre; and what lies just around it is dark:
//
//          o           o  not lit, all but two
//      o  . .  o       x  lit
//        x   x
//     o .  x  . o
//        x   x
//      o  . .  o
//          o
//
// N is the one parameter. It runs over the sizes that the region, or a window, allows in the row of the boundary point.
// What the points find is then measured: contrast, centre and size come from all of its pixels.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "difference.hpp"
#include "error.hpp"
#include "region.hpp"

namespace pong
{

namespace
{

struct Offset {
	int u, v;
};

// The points of a ball of one size, relative to its upper left boundary point.
struct FivePoints {
	double size;
	Offset centre;
	std::array<Offset, 4> lit;  // the centre first: it decides most often
	std::array<Offset, 8> dark; // around the ball
	std::array<Offset, 8> more; // inside of the ball, to confirm what the five points found
	int reach;                  // no point is farther than this
};

const int dark_lit_allowed = 2;  // of eight: noise lights up some
const int more_lit_needed = 7;   // of eight
const double inside = 0.8;       // the lit diagonal points, in radii
const double outside = 1.35;     // the dark points, in radii, and not less than
const double outside_margin = 2; // this far from the outline, px
const double size_step = 1.15;   // from one N to the next: the points forgive half of it

Offset polar(double radius, int eighth)
{
	const double angle = eighth * M_PI / 4;
	return {static_cast<int>(std::lround(radius * std::cos(angle))),
		static_cast<int>(std::lround(radius * std::sin(angle)))};
}

FivePoints five_points(double size)
{
	const double radius = size / 2;
	const Offset upper_left = polar(inside * radius, 5);
	const auto from_upper_left = [&](Offset point) {
		return Offset{point.u - upper_left.u, point.v - upper_left.v};
	};
	FivePoints points = {};
	points.size = size;
	points.centre = from_upper_left({0, 0});
	points.lit = {points.centre, from_upper_left(polar(inside * radius, 1)),
		      from_upper_left(polar(inside * radius, 3)), from_upper_left(polar(inside * radius, 7))};
	const double around = std::max(outside * radius, radius + outside_margin);
	for (int i = 0; i < 8; i++) {
		points.dark[static_cast<size_t>(i)] = from_upper_left(polar(around, i));
		points.more[static_cast<size_t>(i)] = from_upper_left(polar(radius / 2, i));
	}
	points.reach = static_cast<int>(std::ceil(2 * around)) + 2;
	return points;
}

// A rectangle of the picture, [begin, end) in both directions.
struct Area {
	int u_begin, u_end, v_begin, v_end;
};

Area intersect(const Area &a, const Area &b)
{
	return {std::max(a.u_begin, b.u_begin), std::min(a.u_end, b.u_end), std::max(a.v_begin, b.v_begin),
		std::min(a.v_end, b.v_end)};
}

} // namespace

} // namespace pong

using namespace pong;

struct pong_detector {
	const pong_region *region;
	pong_detect_method method;
	double contrast;
	int width, height;
	std::vector<uint8_t> difference; // what is new, grey levels; the picture's size
	std::vector<uint8_t> binary;     // 1 where the difference exceeds the threshold
	std::vector<FivePoints> sizes;   // ascending
	std::vector<pong_detection> hits;
};

namespace pong
{

namespace
{

const size_t hits_capacity = 4096;

// A hit of the five points is a ball only if most of its pixels agree.
const double ball_level = 0.2; // of the contrast: the shaded side of a ball belongs to it
const double disc_lit_needed = 0.75;
const double size_tolerance = 1.3; // between N and the size that is measured

Area searched_area(const pong_detector &detector, const pong_window *window)
{
	const Area picture = {0, detector.width, 0, detector.height};
	if (!window)
		return picture;
	return intersect(picture, {window->u, window->u + window->width, window->v, window->v + window->height});
}

// Fill the difference inside of the area; the rest of the picture is not looked at. Returns the mean of the absolute
// difference to the nearer one of the earlier pictures.
int fill_difference(pong_detector &detector, const pong_pictures &pictures, const Area &area)
{
	const pong_image &current = pictures.current, &earlier = pictures.earlier[0], &before = pictures.earlier[1];
	int64_t sum = 0;
	for (int v = area.v_begin; v < area.v_end; v++) {
		const uint8_t *now = current.pixels + v * current.stride;
		const uint8_t *then = earlier.pixels + v * earlier.stride;
		const uint8_t *older = before.pixels + v * before.stride;
		uint8_t *difference = &detector.difference[static_cast<size_t>(v) * detector.width];
		uint32_t row_sum = 0;
		for (int u = area.u_begin; u < area.u_end; u++)
			row_sum += brighter(now[u], then[u]) + brighter(then[u], now[u]);
		if (detector.method == PONG_DETECT_DIFFERENCE)
			for (int u = area.u_begin; u < area.u_end; u++)
				difference[u] = brighter(now[u], then[u]);
		else
			for (int u = area.u_begin; u < area.u_end; u++)
				difference[u] = beyond_both(now[u], then[u], older[u]);
		sum += row_sum;
	}
	const int64_t pixels = static_cast<int64_t>(area.u_end - area.u_begin) * (area.v_end - area.v_begin);
	return static_cast<int>(sum / pixels);
}

// The paper's threshold is that mean (section 4.2). Where little moves the mean is that of the noise, and a third of
// all pixels exceed it; this many times the mean few do.
const int noise_factor = 2;

void make_binary(pong_detector &detector, int threshold, const Area &area)
{
	for (int v = area.v_begin; v < area.v_end; v++) {
		const uint8_t *difference = &detector.difference[static_cast<size_t>(v) * detector.width];
		uint8_t *binary = &detector.binary[static_cast<size_t>(v) * detector.width];
		for (int u = area.u_begin; u < area.u_end; u++)
			binary[u] = difference[u] > threshold;
	}
}

// The five points at one place. The upper left one is lit already.
bool match(const pong_detector &detector, const Area &area, const FivePoints &points, int u, int v)
{
	const uint8_t *binary = detector.binary.data();
	const auto lit = [&](Offset offset) {
		const int x = u + offset.u, y = v + offset.v;
		return x >= area.u_begin && x < area.u_end && y >= area.v_begin && y < area.v_end &&
		       binary[static_cast<size_t>(y) * detector.width + x];
	};
	for (const Offset &offset : points.lit)
		if (!lit(offset))
			return false;
	const auto count_lit = [&](const std::array<Offset, 8> &offsets) {
		return std::count_if(offsets.begin(), offsets.end(), lit);
	};
	return count_lit(points.dark) <= dark_lit_allowed && count_lit(points.more) >= more_lit_needed;
}

// Measure a hit: the contrast between its inside and a ring around it, then centre and size of all that is brighter
// than half of that. Returns false where it is not a ball after all.
bool measure(const pong_detector &detector, const Area &area, pong_detection &hit)
{
	const double radius = hit.size / 2, ring = 1.3 * radius + outside_margin, out = ring + 2;
	const int reach = static_cast<int>(std::ceil(out));
	const int u0 = static_cast<int>(std::lround(hit.u)), v0 = static_cast<int>(std::lround(hit.v));
	const Area box = intersect(area, {u0 - reach, u0 + reach + 1, v0 - reach, v0 + reach + 1});
	const auto for_each_pixel = [&](auto &&visit) {
		for (int v = box.v_begin; v < box.v_end; v++)
			for (int u = box.u_begin; u < box.u_end; u++)
				visit(u, v, (u - hit.u) * (u - hit.u) + (v - hit.v) * (v - hit.v),
				      detector.difference[static_cast<size_t>(v) * detector.width + u]);
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
	if (hit.contrast < detector.contrast)
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
	if (core_lit < disc_lit_needed * core_count || ring_lit > 0.25 * around_count)
		return false;
	const double size = 2 * std::sqrt(count / M_PI);
	if (size > size_tolerance * hit.size || hit.size > size_tolerance * size)
		return false;
	hit.u = sum_u / count;
	hit.v = sum_v / count;
	hit.size = size;
	return true;
}

// The sizes that a ball may have in one row, widened by what the points forgive.
struct Sizes {
	double least, greatest;
};

Sizes sizes_in_row(const pong_detector &detector, const pong_window *window, int v)
{
	const pong_region_row &row = detector.region->rows[static_cast<size_t>(v)];
	const double forgiven = std::sqrt(size_step);
	return window ? Sizes{window->size_min / forgiven, window->size_max * forgiven}
		      : Sizes{row.size_min / forgiven, row.size_max * forgiven};
}

void match_sizes(pong_detector &detector, const Area &area, const Sizes &sizes, int u, int v)
{
	for (const FivePoints &points : detector.sizes)
		if (points.size >= sizes.least && points.size < sizes.greatest && match(detector, area, points, u, v) &&
		    detector.hits.size() < hits_capacity)
			detector.hits.push_back({static_cast<double>(u + points.centre.u),
						 static_cast<double>(v + points.centre.v), points.size, 0});
}

// Scan for upper left boundary points, and try the sizes there. Such a point is lit, and so are its neighbours on the
// ball's side: that passes over the single lit pixels that noise makes.
void scan(pong_detector &detector, const Area &area, const pong_window *window)
{
	detector.hits.clear();
	for (int v = area.v_begin; v < area.v_end - 1; v++) {
		const pong_region_row &row = detector.region->rows[static_cast<size_t>(v)];
		const Sizes sizes = sizes_in_row(detector, window, v);
		const int u_begin = std::max(row.begin, area.u_begin), u_end = std::min(row.end, area.u_end) - 1;
		const uint8_t *binary = &detector.binary[static_cast<size_t>(v) * detector.width];
		const uint8_t *below = binary + detector.width;
		for (int u = u_begin; u < u_end; u++)
			if (binary[u] & binary[u + 1] & below[u] & below[u + 1])
				match_sizes(detector, area, sizes, u, v);
	}
}

// Many hits tell of one ball: the first that measures well stands for all. Measured twice, for the hit's centre and
// size are only as good as the five points.
int measure_hits(const pong_detector &detector, const Area &area, pong_detection *found, int capacity)
{
	int count = 0;
	for (pong_detection hit : detector.hits) {
		const bool known = std::any_of(found, found + count, [&](const pong_detection &ball) {
			return std::hypot(ball.u - hit.u, ball.v - hit.v) < std::max(ball.size, hit.size) / 2;
		});
		if (known || !measure(detector, area, hit) || !measure(detector, area, hit))
			continue;
		if (count < capacity)
			found[count++] = hit;
		else if (found[count - 1].contrast < hit.contrast)
			found[count - 1] = hit;
		std::sort(found, found + count,
			  [](const pong_detection &a, const pong_detection &b) { return a.contrast > b.contrast; });
	}
	return count;
}

pong_detector *make_detector(const pong_region *region, const pong_settings &settings)
{
	const size_t pixels = static_cast<size_t>(region->width) * region->height;
	pong_detector *detector = new pong_detector{region,
						    settings.detect.method,
						    settings.detect.contrast,
						    region->width,
						    region->height,
						    std::vector<uint8_t>(pixels),
						    std::vector<uint8_t>(pixels),
						    {},
						    {}};
	detector->hits.reserve(hits_capacity);
	double least = INFINITY, greatest = 0;
	for (const pong_region_row &row : region->rows) {
		if (row.begin == row.end)
			continue;
		least = std::min(least, row.size_min);
		greatest = std::max(greatest, row.size_max);
	}
	greatest = std::min(greatest, 0.5 * std::min(region->width, region->height));
	for (double size = std::max(least, 3.0) / size_step; size < greatest * size_step; size *= size_step)
		detector->sizes.push_back(five_points(size));
	return detector;
}

} // namespace

} // namespace pong

pong_detector *pong_detector_new(const pong_region *region, const pong_settings *settings, pong_error *error)
{
	return guarded_new(error, [&] { return make_detector(region, *settings); });
}

void pong_detector_free(pong_detector *detector)
{
	delete detector;
}

int pong_detect(pong_detector *detector, const pong_pictures *pictures, const pong_window *window,
		pong_detection *found, int capacity)
{
	const Area area = searched_area(*detector, window);
	if (area.u_begin >= area.u_end || area.v_begin >= area.v_end || capacity < 1)
		return 0;
	const int mean = fill_difference(*detector, *pictures, area);
	make_binary(*detector, detector->method == PONG_DETECT_DIFFERENCE ? mean : noise_factor * mean + 1, area);
	scan(*detector, area, window);
	return measure_hits(*detector, area, found, capacity);
}
