#include "blob.hpp"

#include <array>
#include <cmath>

#include "clones.hpp"
#include "vectors.hpp"

namespace pong
{

namespace
{

const double lit_part = 0.25;       // of the contrast: the shaded side of a ball belongs to it
const double lit_noise = 3.5;       // and this many standard deviations
const double spread = 1.0;          // how much larger than the ball what is lit is, px of the diameter
const double size_tolerance = 1.3;  // of the size that is measured against the sizes allowed
const double longest = 2.6;         // streak: length over width
const double ellipse_needed = 0.88; // area over that of the ellipse of the same moments
const int margin = 2;               // between the ball and the frame around it, px
const int frame_width = 2;          // px
const double frame_lit_allowed = 0.25;
const double diagonal = 0.7;  // where the diagonal points are, in half axes
const int around_allowed = 2; // of eight points around the ball
const int pixels_needed = 4;
const double hull_lit_needed = 0.55; // of a convex hull
const int hull_points_needed = 3;    // of five
const double hull_longest = 1.5;     // its length over its width
const size_t hull_rows = 512;        // the largest hull

// Pixels of a patch: rows of `width`, `stride` apart.
struct Pixels {
	const int16_t *first;
	ptrdiff_t stride;
	int width, height;
};

Pixels pixels_of(const Patch &patch, const Area &area)
{
	return {patch.pixel(area.u_begin, area.v_begin), patch.stride(), area.u_end - area.u_begin,
		area.v_end - area.v_begin};
}

// Sums over the lit pixels of an area, about its upper left corner.
struct Moments {
	double count = 0, u = 0, v = 0, uu = 0, uv = 0, vv = 0;
	double level = 0;

	void add(double row_count, double row_u, double row_uu, double at_v)
	{
		count += row_count;
		u += row_u;
		uu += row_uu;
		v += at_v * row_count;
		uv += at_v * row_u;
		vv += at_v * at_v * row_count;
	}

	// Sums about another corner, so much farther right and down.
	void add(const Moments &other, double right, double down)
	{
		count += other.count;
		u += other.u + right * other.count;
		v += other.v + down * other.count;
		uu += other.uu + right * (2 * other.u + right * other.count);
		uv += other.uv + right * other.v + down * (other.u + right * other.count);
		vv += other.vv + down * (2 * other.v + down * other.count);
		level += other.level;
	}

	// Pixels from `from` to `to`, both included, ends between pixels allowed.
	void add_span(double from, double to, double at_v)
	{
		const double length = to - from + 1, middle = (from + to) / 2;
		add(length, length * middle, length * (middle * middle + length * length / 12), at_v);
	}
};

const int rows_together = 28; // so many have sums of 16 bits: a patch shows 255 * patch_one at most

// std::hypot guards against numbers that do not come here, and takes longer.
double length(double a, double b)
{
	return std::sqrt(a * a + b * b);
}

// The ellipse with the same moments: its middle and half axes.
struct Ellipse {
	double u, v, major, minor;
	double axis_u, axis_v; // direction of the major one, a unit vector
	double fill;           // the area of what is lit over the ellipse's

	Ellipse(const Moments &m, const Area &area)
	{
		u = m.u / m.count;
		v = m.v / m.count;
		// A pixel is a square, not a point: 1/12.
		const double uu = m.uu / m.count - u * u + 1.0 / 12, vv = m.vv / m.count - v * v + 1.0 / 12;
		const double uv = m.uv / m.count - u * v;
		const double mean = (uu + vv) / 2, apart = (uu - vv) / 2, half = length(apart, uv);
		major = 2 * std::sqrt(mean + half);
		minor = 2 * std::sqrt(std::max(mean - half, 0.0));
		const double twice = half > 0 ? apart / half : 1; // cosine of twice the major axis' angle
		axis_u = std::sqrt((1 + twice) / 2);
		axis_v = std::copysign(std::sqrt((1 - twice) / 2), uv);
		fill = m.count / (M_PI * major * minor);
		u += area.u_begin;
		v += area.v_begin;
	}

	double size() const
	{
		return 2 * minor - spread;
	}

	// The smallest rectangle around it.
	Area box() const
	{
		const double half_u = length(major * axis_u, minor * axis_v);
		const double half_v = length(major * axis_v, minor * axis_u);
		return {static_cast<int>(std::floor(u - half_u)), static_cast<int>(std::ceil(u + half_u)) + 1,
			static_cast<int>(std::floor(v - half_v)), static_cast<int>(std::ceil(v + half_v)) + 1};
	}
};

bool may_be_ball(const Ellipse &ellipse, const BallLimits &limits)
{
	return ellipse.size() * size_tolerance >= limits.size_min &&
	       ellipse.size() <= size_tolerance * limits.size_max && ellipse.major <= longest * ellipse.minor &&
	       ellipse.fill >= ellipse_needed;
}

// The convex hull's edge on one side of some rows: of points (row, end), ends far out win.
class HullSide
{
public:
	void add(int row, int end)
	{
		while (count_ > 1 && !turns_in(points_[count_ - 2], points_[count_ - 1], {row, end}))
			count_--;
		points_[count_++] = {row, end};
	}

	// The edge at a row between the first and the last one; rows ascend from call to call.
	double at(int row)
	{
		while (reached_ + 2 < count_ && points_[reached_ + 1].row <= row)
			reached_++;
		const Point &a = points_[reached_];
		if (reached_ + 1 == count_)
			return a.end;
		const Point &b = points_[reached_ + 1];
		return a.end + static_cast<double>(b.end - a.end) * (row - a.row) / (b.row - a.row);
	}

private:
	struct Point {
		int row, end;
	};

	static bool turns_in(const Point &a, const Point &b, const Point &c)
	{
		return (b.end - a.end) * (c.row - b.row) > (c.end - b.end) * (b.row - a.row);
	}

	std::array<Point, hull_rows> points_;
	size_t count_ = 0, reached_ = 0;
};

// The moments of the convex hull of what is lit. A ball before the edge of a bright wall is brighter than one part of
// what is behind it and darker than the other; somewhere it looks like neither, and is not lit.
Moments hull_moments(const Patch &patch, const Area &area, int level)
{
	Moments moments;
	HullSide left, right; // the left ends negated: far out wins
	int first = -1, last = -1;
	if (area.v_end - area.v_begin > static_cast<int>(hull_rows))
		return moments;
	for (int row = 0; row < area.v_end - area.v_begin; row++) {
		const int16_t *pixels = patch.pixel(area.u_begin, area.v_begin + row);
		int begin = 0, end = area.u_end - area.u_begin - 1;
		while (begin <= end && pixels[begin] <= level)
			begin++;
		while (end > begin && pixels[end] <= level)
			end--;
		if (begin > end)
			continue;
		left.add(row, -begin);
		right.add(row, end);
		first = first < 0 ? row : first;
		last = row;
	}
	for (int row = first; first >= 0 && row <= last; row++)
		moments.add_span(-left.at(row), right.at(row), row);
	return moments;
}

// Eighths of a turn.
struct Direction {
	double cosine, sine;
};
const double root_half = M_SQRT1_2;
const std::array<Direction, 8> eighths = {{{1, 0},
					   {root_half, root_half},
					   {0, 1},
					   {-root_half, root_half},
					   {-1, 0},
					   {-root_half, -root_half},
					   {0, -1},
					   {root_half, -root_half}}};

// The five points of the ellipse: of the centre and the four diagonal points inside as many as needed are lit; of the
// eight around it all but two are dark.
bool shows_five_points(const Patch &patch, const Ellipse &ellipse, int level, int needed)
{
	const auto lit = [&](double radii, double extra, int eighth) {
		const double a = (radii * ellipse.major + extra) * eighths[static_cast<size_t>(eighth)].cosine;
		const double b = (radii * ellipse.minor + extra) * eighths[static_cast<size_t>(eighth)].sine;
		return patch.at(static_cast<int>(std::lrint(ellipse.u + a * ellipse.axis_u - b * ellipse.axis_v)),
				static_cast<int>(std::lrint(ellipse.v + a * ellipse.axis_v + b * ellipse.axis_u))) >
		       level;
	};
	int inside = lit(0, 0, 0), around = 0;
	for (int eighth = 1; eighth < 8; eighth += 2)
		inside += lit(diagonal, 0, eighth);
	for (int eighth = 0; eighth < 8; eighth++)
		around += lit(1, margin, eighth);
	return inside >= needed && around <= around_allowed;
}

} // namespace

// Of a few rows, and as many columns as make a vector or fewer.
PONG_CLONES static void sum_block(const Pixels &pixels, int level, Moments *moments)
{
	const Words u = places, inside = u < static_cast<int16_t>(pixels.width);
	Words count = {}, v = {}, vv = {}, at = {}; // the last is the row's number
	Naturals levels = {};
	const int16_t *row = pixels.first;
	for (int i = 0; i < pixels.height; i++, row += pixels.stride, at += 1) {
		Words shown;
		load(row, shown);
		const Words lit = inside & (shown > static_cast<int16_t>(level)); // -1 where lit
		count -= lit;
		v += lit & at;
		vv += lit & (at * at);
		levels += reinterpret_cast<Naturals>(lit & shown);
	}
	*moments = {double(sum_of(count)),         double(sum_of(u * count)), double(sum_of(v)),
		    double(sum_of(u * u * count)), double(sum_of(u * v)),     double(sum_of(vv)),
		    double(sum_of(levels))};
}

// In blocks of columns, for vectors, and of rows, for sums of few bits.
static Moments sum_lit(const Pixels &pixels, int level)
{
	Moments moments;
	for (int u = 0; u < pixels.width; u += together)
		for (int v = 0; v < pixels.height; v += rows_together) {
			Moments block;
			sum_block({pixels.first + v * pixels.stride + u, pixels.stride,
				   std::min(together, pixels.width - u), std::min(rows_together, pixels.height - v)},
				  level, &block);
			moments.add(block, u, v);
		}
	return moments;
}

// Rows of fewer pixels than overflow 16 bits.
PONG_CLONES static int count_lit(const Pixels &pixels, int level)
{
	int lit = 0;
	for (int u = 0; u < pixels.width; u += together) {
		const Words inside = places < static_cast<int16_t>(std::min(together, pixels.width - u));
		Words count = {};
		const int16_t *row = pixels.first + u;
		for (int v = 0; v < pixels.height; v++, row += pixels.stride) {
			Words shown;
			load(row, shown);
			count -= inside & (shown > static_cast<int16_t>(level));
		}
		lit += sum_of(count);
	}
	return lit;
}

// The part of the frame around an area that is lit.
static double frame_lit(const Patch &patch, const Area &area, int level)
{
	const auto grown = [&](int by) {
		return intersect(patch.area(),
				 {area.u_begin - by, area.u_end + by, area.v_begin - by, area.v_end + by});
	};
	const Area outer = grown(margin + frame_width), inner = grown(margin);
	const Area sides[] = {{outer.u_begin, outer.u_end, outer.v_begin, inner.v_begin},
			      {outer.u_begin, outer.u_end, inner.v_end, outer.v_end},
			      {outer.u_begin, inner.u_begin, inner.v_begin, inner.v_end},
			      {inner.u_end, outer.u_end, inner.v_begin, inner.v_end}};
	int frame = 0, lit = 0;
	for (const Area &side : sides) {
		const Pixels pixels = pixels_of(patch, side);
		frame += pixels.width * pixels.height;
		lit += count_lit(pixels, level);
	}
	return frame > 0 ? double(lit) / frame : 0;
}

double lit_level(double contrast, const BallLimits &limits)
{
	return std::max(lit_part * contrast, lit_noise * limits.noise);
}

bool measure_blob(const Patch &patch, const Area &area, double contrast, const BallLimits &limits, pong_detection *ball)
{
	const int level = static_cast<int>(patch_one * lit_level(contrast, limits));
	const Moments lit = sum_lit(pixels_of(patch, area), level);
	const double shown = lit.level / lit.count / patch_one; // grey levels
	if (lit.count < pixels_needed || shown < limits.contrast)
		return false;
	Ellipse ellipse(lit, area);
	int points_needed = 5;
	if (!may_be_ball(ellipse, limits)) {
		const Moments hull = hull_moments(patch, area, level);
		if (lit.count < hull_lit_needed * hull.count)
			return false;
		ellipse = Ellipse(hull, area);
		points_needed = hull_points_needed;
		if (!may_be_ball(ellipse, limits) || ellipse.major > hull_longest * ellipse.minor)
			return false;
	}
	if (!shows_five_points(patch, ellipse, level, points_needed) ||
	    frame_lit(patch, ellipse.box(), level) > frame_lit_allowed)
		return false;
	*ball = {ellipse.u, ellipse.v, ellipse.size(), shown};
	return true;
}

} // namespace pong
