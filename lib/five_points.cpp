#include "five_points.hpp"

#include <algorithm>
#include <cmath>

#include "region.hpp"

namespace pong
{

namespace
{

const double inside = 0.8;       // the lit diagonal points, in radii
const double outside = 1.35;     // the dark points, in radii, and not less than
const double outside_margin = 2; // this far from the outline, px
const double size_step = 1.15;   // from one N to the next: the points forgive half of it
const double size_least = 3;     // px; a smaller ball has no five points

Offset polar(double radius, int eighth)
{
	const double angle = eighth * M_PI / 4;
	return {static_cast<int>(std::lround(radius * std::cos(angle))),
		static_cast<int>(std::lround(radius * std::sin(angle)))};
}

} // namespace

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
	return points;
}

std::vector<FivePoints> five_points_of(const pong_region &region)
{
	double least = INFINITY, greatest = 0;
	for (const pong_region_row &row : region.rows) {
		if (row.begin == row.end)
			continue;
		least = std::min(least, row.size_min);
		greatest = std::max(greatest, row.size_max);
	}
	greatest = std::min(greatest, 0.5 * std::min(region.width, region.height));
	std::vector<FivePoints> table;
	for (double size = std::max(least, size_least) / size_step; size < greatest * size_step; size *= size_step)
		table.push_back(five_points(size));
	return table;
}

FivePointsRange sizes_between(const std::vector<FivePoints> &table, double size_min, double size_max)
{
	const auto smaller = [](const FivePoints &points, double size) { return points.size < size; };
	const FivePoints *begin = table.data(), *end = begin + table.size();
	return {std::lower_bound(begin, end, size_min / std::sqrt(size_step), smaller),
		std::lower_bound(begin, end, size_max * std::sqrt(size_step), smaller)};
}

} // namespace pong
