#include "doubt.hpp"

#include <algorithm>
#include <cmath>

namespace pong
{

namespace
{

const double epipolar = 1, epipolar_size = 0.03; // px, and parts of the radius
const double size = 0.06, size_error = 0.5;      // parts of the radius, and px: far balls are small
const double sizes = 0.03, sizes_error = 0.2;    // the two with each other: what light does to one, it does to both
const double outline_shown = 0.87;               // an arm's end shows less

const double rough_epipolar = 3, rough_epipolar_size = 0.2; // as epipolar and its size, of what was detected
const double rough_size = 0.35, rough_size_error = 3;       // parts of the diameter, and px

} // namespace

bool may_be_one(const pong_rig &rig, const pong_detection &left, const pong_detection &right)
{
	const double left_uv[2] = {left.u, left.v}, right_uv[2] = {right.u, right.v};
	double position[3];
	if (!(std::abs(pong_epipolar_distance(rig.camera, left_uv, right_uv)) <=
	      rough_epipolar + rough_epipolar_size * (left.size + right.size) / 2) ||
	    !pong_triangulate(rig.camera, left_uv, right_uv, position))
		return false;
	const pong_detection *found[2] = {&left, &right};
	for (int side = 0; side < 2; side++) {
		const double expected = pong_apparent_size(&rig.camera[side], position, rig.ball.diameter);
		if (!(std::abs(found[side]->size - expected) <= rough_size * expected + rough_size_error))
			return false;
	}
	return true;
}

double doubt_of_centres(const pong_rig &rig, const pong_centre &left, const pong_centre &right, const pong_point &point)
{
	const double left_uv[2] = {left.u, left.v}, right_uv[2] = {right.u, right.v};
	const double reach = epipolar + epipolar_size * (left.radius + right.radius) / 2;
	double doubt = std::abs(pong_epipolar_distance(rig.camera, left_uv, right_uv)) / reach;
	double off[2]; // by how much each is larger than expected, px of the radius
	const pong_centre *centre[2] = {&left, &right};
	double expected = 0;
	for (int side = 0; side < 2; side++) {
		expected = pong_apparent_size(&rig.camera[side], point.position, rig.ball.diameter) / 2;
		off[side] = centre[side]->radius - expected;
		doubt = std::max(doubt, std::abs(off[side]) / (size * expected + size_error));
	}
	return std::max(doubt, std::abs(off[0] - off[1]) / (sizes * expected + sizes_error));
}

double doubt_of_outline(double shown)
{
	return (1 - shown) / (1 - outline_shown);
}

} // namespace pong
