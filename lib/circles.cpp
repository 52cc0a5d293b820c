// 1. Eight directions: the grey level steps between just inside and just outside of the circle in all but two. Most
//    circles fail at once, so all places of a grid and all sizes can be tried.
// 2. Of those that pass, the few with the strongest steps are moved and resized to where their outline is strongest,
//    and must show it nearly all round.
#include "circles.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "outline.hpp"

namespace pong
{

namespace
{

const int directions = 8;
const int missed_allowed = 2;      // of eight
const double beside = 1.5;         // of the outline, where the step's two levels are read, px
const double step_noise = 4;       // least step, standard deviations of a pixel
const double size_step = 1.2;      // from one size to the next
const int grid_least = 2;          // px
const double grid = 0.3;           // from one place to the next, radii
const size_t passed_capacity = 12; // circles that pass the first test, the strongest
const size_t refined_most = 3;     // and the second
const double shown_first = 0.6;    // of the outline, before that
const double radius_least = 3;     // px; smaller circles are everywhere
const int refinements = 6;
const double near_grid = 0.25; // a circle of known size near a known place: from one place tried to the next, radii,
const int near_steps = 3;      // and how many to each side
const double near_radii = 0.7; // circles with centres nearer than this are one

// How much of a circle must show.
struct Needed {
	double shown; // of its outline
	double step;  // standard deviations of a pixel
};

// Anywhere, a hand's outline must not pass. Right where a ball is expected, its shaded side may be as dark as what is
// behind it.
const Needed needed_anywhere = {0.85, 8}, needed_in_window = {0.75, 8}, needed_there = {0.55, 5};
const double narrow = 4; // a window less than so many balls wide tells where in it the ball is

// Where the levels inside and outside of a circle of one size are read, as offsets into the picture.
struct Probe {
	ptrdiff_t in[directions], out[directions];
	int reach; // how far from the centre any of them lies, px

	Probe(double radius, ptrdiff_t stride) : reach(static_cast<int>(std::ceil(radius + beside)))
	{
		// Opposite directions follow each other: what is bright on one side only is dismissed soonest.
		const int order[directions] = {0, 4, 2, 6, 1, 5, 3, 7};
		const auto offset = [&](double distance, int eighth) {
			const double angle = eighth * M_PI / 4;
			return std::lround(distance * std::sin(angle)) * stride +
			       std::lround(distance * std::cos(angle));
		};
		for (int i = 0; i < directions; i++) {
			in[i] = offset(std::max(radius - beside, radius / 2), order[i]);
			out[i] = offset(radius + beside, order[i]);
		}
	}

	// The sum of the steps, or 0 where more are missing than allowed.
	int strength(const uint8_t *centre, int step) const
	{
		int missed = 0, sum = 0;
		for (int i = 0; i < directions; i++) {
			const int difference = std::abs(centre[in[i]] - centre[out[i]]);
			sum += difference;
			missed += difference < step;
			if (missed > missed_allowed)
				return 0;
		}
		return sum;
	}
};

struct Circle {
	double u, v, radius;
	double strength; // of the first test
	Outline outline;

	double score() const
	{
		return outline.shown * outline.step;
	}
};

class CircleSearch
{
public:
	CircleSearch(const pong_image &image, const CircleSought &sought) : image_(image), sought_(sought)
	{
	}

	Circle measured(double u, double v, double radius) const
	{
		const BallLimits &limits = sought_.limits;
		const double allowed = std::clamp(radius, limits.size_min / 2, limits.size_max / 2);
		return {u, v, allowed, 0, measure_outline(image_, u, v, allowed, sought_.noise)};
	}

	// Step by step to the neighbour with the strongest outline, by ever smaller steps.
	Circle refined(Circle circle, double step) const
	{
		for (int i = 0; i < refinements; i++) {
			const Circle neighbours[] = {measured(circle.u - step, circle.v, circle.radius),
						     measured(circle.u + step, circle.v, circle.radius),
						     measured(circle.u, circle.v - step, circle.radius),
						     measured(circle.u, circle.v + step, circle.radius),
						     measured(circle.u, circle.v, circle.radius - step / 2),
						     measured(circle.u, circle.v, circle.radius + step / 2)};
			const Circle &best = *std::max_element(
				std::begin(neighbours), std::end(neighbours),
				[](const Circle &a, const Circle &b) { return a.score() < b.score(); });
			if (best.score() > circle.score())
				circle = best;
			else
				step /= 2;
		}
		return circle;
	}

	bool is_ball(const Circle &circle, const Needed &needed) const
	{
		return circle.outline.shown >= needed.shown && circle.outline.step >= needed.step * sought_.noise;
	}

private:
	const pong_image &image_;
	const CircleSought &sought_;
};

// Whether what is around the centre is new: most of five points inside of the circle.
bool is_lit(const Patch &patch, int u, int v, int half, int level)
{
	const int lit = (patch.at(u, v) > level) + (patch.at(u - half, v) > level) + (patch.at(u + half, v) > level) +
			(patch.at(u, v - half) > level) + (patch.at(u, v + half) > level);
	return lit >= 3;
}

// The strongest circles that pass the first test, of any that overlap only one.
class Passed
{
public:
	void add(const Circle &circle)
	{
		if (count_ == passed_capacity && !weaker(*std::min_element(begin(), end(), weaker), circle))
			return;
		for (Circle &other : *this)
			if (overlap(circle, other)) {
				if (other.strength < circle.strength)
					other = circle;
				return;
			}
		if (count_ < passed_capacity)
			circles_[count_++] = circle;
		else if (Circle &weakest = *std::min_element(begin(), end(), weaker); weaker(weakest, circle))
			weakest = circle;
	}

	Circle *begin()
	{
		return circles_;
	}
	Circle *end()
	{
		return circles_ + count_;
	}

private:
	static bool weaker(const Circle &a, const Circle &b)
	{
		return a.strength < b.strength;
	}

	static bool overlap(const Circle &a, const Circle &b)
	{
		const double du = a.u - b.u, dv = a.v - b.v, reach = near_radii * std::max(a.radius, b.radius);
		return du * du + dv * dv < reach * reach;
	}

	Circle circles_[passed_capacity];
	size_t count_ = 0;
};

// All circles of one size.
void probe_circles(const pong_image &image, const Patch &patch, const Area &area, double radius,
		   const CircleSought &sought, Passed *passed)
{
	const int level = static_cast<int>(patch_one * lit_level(0, sought.limits));
	const int step = static_cast<int>(std::ceil(step_noise * sought.noise));
	const Probe probe(radius, image.stride);
	const int every = std::max(grid_least, static_cast<int>(grid * radius)), half = static_cast<int>(radius / 2);
	const Area inside =
		intersect(area, {probe.reach, image.width - probe.reach, probe.reach, image.height - probe.reach});
	for (int v = inside.v_begin; v < inside.v_end; v += every)
		for (int u = inside.u_begin; u < inside.u_end; u += every) {
			const int strength = probe.strength(image.pixels + v * image.stride + u, step);
			if (strength > 0 && is_lit(patch, u, v, half, level))
				passed->add({double(u), double(v), radius, double(strength), {}});
		}
}

// Collects the circles that are balls.
struct Found {
	pong_detection *found;
	int count, capacity;

	void add(const Circle &circle)
	{
		const pong_detection ball = {circle.u, circle.v, 2 * circle.radius, circle.outline.step};
		if (!is_known(ball, found, count))
			count = insert_detection(ball, found, count, capacity);
	}
};

// The circle right where a ball is expected, whatever else is seen around.
void try_expected(const CircleSearch &search, const pong_window &window, Found *found)
{
	const Circle expected = search.measured(window.u + window.width / 2.0, window.v + window.height / 2.0,
						(window.size_min + window.size_max) / 4);
	const Circle fine = search.refined(expected, grid / 2 * expected.radius);
	if (search.is_ball(fine, needed_there))
		found->add(fine);
}

} // namespace

int find_circles(const pong_image &image, const Patch &patch, const Area &area, const CircleSought &sought,
		 pong_detection *found, int count, int capacity)
{
	const CircleSearch search(image, sought);
	const BallLimits &limits = sought.limits;
	const pong_window *window = sought.window;
	Found balls = {found, count, capacity};
	if (window && window->width < narrow * window->size_max)
		try_expected(search, *window, &balls);
	const int extent = std::max(area.u_end - area.u_begin, area.v_end - area.v_begin);
	const double radius_most = std::min(limits.size_max / 2, 0.6 * extent);
	Passed passed;
	for (double radius = std::max(limits.size_min / 2, radius_least); radius <= radius_most; radius *= size_step)
		probe_circles(image, patch, area, radius, sought, &passed);
	for (Circle &circle : passed)
		circle.outline = search.measured(circle.u, circle.v, circle.radius).outline;
	std::sort(passed.begin(), passed.end(), [](const Circle &a, const Circle &b) { return a.score() > b.score(); });
	const Circle *last = std::min(passed.end(), passed.begin() + refined_most);
	for (const Circle *circle = passed.begin(); circle != last; circle++) {
		if (circle->outline.shown < shown_first)
			continue;
		const Circle fine = search.refined(*circle, grid * circle->radius);
		if (search.is_ball(fine, window ? needed_in_window : needed_anywhere))
			balls.add(fine);
	}
	return balls.count;
}

bool find_circle_near(const pong_image &image, double noise, pong_detection *place)
{
	const CircleSought sought = {{place->size, place->size, 0, 0}, noise, nullptr};
	const CircleSearch search(image, sought);
	const double radius = place->size / 2, step = near_grid * radius;
	Circle best = search.measured(place->u, place->v, radius);
	for (int down = -near_steps; down <= near_steps; down++)
		for (int right = -near_steps; right <= near_steps; right++) {
			const Circle circle = search.measured(place->u + right * step, place->v + down * step, radius);
			if (circle.score() > best.score())
				best = circle;
		}
	const Circle fine = search.refined(best, step / 2);
	*place = {fine.u, fine.v, place->size, fine.outline.step};
	return search.is_ball(fine, needed_there);
}

} // namespace pong
