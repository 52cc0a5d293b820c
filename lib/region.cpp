// Where in a picture a ball can be (paper, section 4.1). The table's four corners are known, so are the lines that its
// sides make in the picture. A ball flies above the table: between the vertical planes that stand on these lines, under
// a ceiling. A pixel belongs to the region if its ray passes through that box; where the ray enters and leaves it, the
// ball is largest and smallest.
#include <algorithm>
#include <cmath>

#include "camera.hpp"
#include "error.hpp"
#include "region.hpp"

namespace pong
{

namespace
{

struct Box {
	Vector3 low, high;
};

// The part of a ray inside of the box, as distances along it; empty where enter > leave.
struct Span {
	double enter, leave;
};

Box flight_box(const pong_rig &rig, const pong_settings &settings)
{
	const double side = rig.table.width / 2 + settings.region.margin;
	return {{-side, 0, rig.hit_z}, {side, settings.region.ceiling, rig.table.length + settings.region.behind}};
}

// Slab by slab.
Span clip(const Box &box, const Vector3 &origin, const Vector3 &direction)
{
	Span span = {0, INFINITY};
	for (int axis = 0; axis < 3; axis++) {
		double a = (box.low[axis] - origin[axis]) / direction[axis];
		double b = (box.high[axis] - origin[axis]) / direction[axis];
		if (a > b)
			std::swap(a, b);
		span.enter = std::max(span.enter, a); // a NaN (0/0, a ray inside of a side) leaves the span as it is
		span.leave = std::min(span.leave, b);
	}
	return span;
}

// A ball closer than this fills the picture.
const double nearest = 0.2; // m
const int column_step = 4;  // px; the border of the region need not be finer

pong_region_row clip_row(const Camera &camera, const Box &box, double diameter, int v, int width)
{
	pong_region_row row = {width, 0, INFINITY, 0};
	for (int u = 0; u < width; u += column_step) {
		const Vector3 ray = camera.ray(Vector2(u, v));
		const Span span = clip(box, camera.centre, ray);
		const double depth_per_distance = camera.R.row(2).dot(ray);
		const double leave = span.leave * depth_per_distance;
		if (!(span.enter < span.leave) || leave < nearest)
			continue;
		const double enter = std::max(span.enter * depth_per_distance, nearest);
		row.begin = std::min(row.begin, u);
		row.end = std::max(row.end, std::min(u + column_step, width));
		row.size_min = std::min(row.size_min, camera.apparent_size(diameter, leave));
		row.size_max = std::max(row.size_max, camera.apparent_size(diameter, enter));
	}
	return row.begin < row.end ? row : pong_region_row{0, 0, 0, 0};
}

pong_region *make_region(const pong_rig &rig, pong_side side, const pong_settings &settings)
{
	const pong_camera &seen_by = rig.camera[side];
	const Camera camera(seen_by);
	pong_region region = {seen_by.width, seen_by.height, {}};
	for (int v = 0; v < region.height; v++) {
		if (rig.table.present)
			region.rows.push_back(
				clip_row(camera, flight_box(rig, settings), rig.ball.diameter, v, region.width));
		else
			region.rows.push_back({0, region.width,
					       camera.apparent_size(rig.ball.diameter, settings.region.distance[1]),
					       camera.apparent_size(rig.ball.diameter, settings.region.distance[0])});
	}
	const bool empty = std::all_of(region.rows.begin(), region.rows.end(),
				       [](const pong_region_row &row) { return row.begin == row.end; });
	if (empty)
		throw Fault{
			PONG_ERROR_VALUE,
			sentence("the %s camera does not see the space above the table: is its P in the table frame?",
				 side == PONG_LEFT ? "left" : "right")};
	return new pong_region(region);
}

} // namespace

bool in_flight_space(const pong_rig &rig, const pong_settings &settings, const double position[3])
{
	const Box box = flight_box(rig, settings);
	return !rig.table.present ||
	       (position[0] >= box.low.x() && position[0] <= box.high.x() && position[1] >= box.low.y() &&
		position[1] <= box.high.y() && position[2] <= box.high.z());
}

} // namespace pong

pong_region *pong_region_new(const pong_rig *rig, pong_side side, const pong_settings *settings, pong_error *error)
{
	return pong::guarded_new(error, [&] { return pong::make_region(*rig, side, *settings); });
}

void pong_region_free(pong_region *region)
{
	delete region;
}

pong_region_row pong_region_get_row(const pong_region *region, int v)
{
	return region->rows.at(static_cast<size_t>(v));
}
