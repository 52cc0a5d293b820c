// Five-point detection (paper, section 4.2 and Fig. 5). A ball of size N shows as five lit points: its upper left
// boundary point, where a scan meets it first, the other three diagonal ones, and the centre; and what lies just around
// it is dark:
//
//          o           o  not lit, all but two
//      o  . .  o       x  lit
//        x   x
//     o .  x  . o
//        x   x
//      o  . .  o
//          o
//
// N is the one parameter.
#pragma once

#include <array>
#include <vector>

#include "pongeye.h"

namespace pong
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
};

FivePoints five_points(double size);

// All the sizes that a region allows, ascending by steps that the points forgive.
std::vector<FivePoints> five_points_of(const pong_region &region);

// The part of that table for sizes from size_min to size_max.
struct FivePointsRange {
	const FivePoints *first, *last;

	const FivePoints *begin() const
	{
		return first;
	}
	const FivePoints *end() const
	{
		return last;
	}
};
FivePointsRange sizes_between(const std::vector<FivePoints> &table, double size_min, double size_max);

const int dark_lit_allowed = 2; // of eight: noise lights up some
const int more_lit_needed = 7;  // of eight

// Whether lit(u, v) shows the points with their upper left one, which is lit already, at (u, v).
template<class Lit> bool match(const FivePoints &points, int u, int v, Lit lit)
{
	for (const Offset &offset : points.lit)
		if (!lit(u + offset.u, v + offset.v))
			return false;
	const auto count_lit = [&](const std::array<Offset, 8> &offsets) {
		int count = 0;
		for (const Offset &offset : offsets)
			count += lit(u + offset.u, v + offset.v);
		return count;
	};
	return count_lit(points.dark) <= dark_lit_allowed && count_lit(points.more) >= more_lit_needed;
}

} // namespace pong
