#include "room.hpp"

#include <algorithm>
#include <cmath>

#include "texture.hpp"

namespace sim
{

namespace
{

constexpr double line_width = 0.020, middle_line_width = 0.003; // m
constexpr double table_grey = 62, line_grey = 196, tape_grey = 185, mesh_grey = 34;
constexpr double tape_width = 0.015, mesh = 0.0125, thread = 0.0014; // m

// t at which the ray comes to value along an axis; infinity where it does not.
double reach(const Ray &ray, int axis, double value)
{
	const double t = (value - ray.origin[axis]) / ray.direction[axis];
	return t > 0 ? t : INFINITY;
}

bool on_table(const Eigen::Vector3d &point)
{
	return std::abs(point.x()) <= table_width / 2 && point.z() >= 0 && point.z() <= table_length;
}

bool on_net(const Eigen::Vector3d &point)
{
	return std::abs(point.x()) <= net_reach && point.y() >= 0 && point.y() <= net_height;
}

double mix(double below, double above, double cover)
{
	return below + (above - below) * cover;
}

} // namespace

Room::Room(const Background &background, uint64_t seed) : background_(background), seed_(seed)
{
}

Sight Room::look(const Ray &ray, double spread) const
{
	const auto at = [&](double t) { return Eigen::Vector3d(ray.origin + t * ray.direction); };
	const double to_table = reach(ray, 1, 0), to_floor = reach(ray, 1, floor_y);
	const double to_wall = reach(ray, 2, background_.distance);
	Sight sight = {};
	if (std::isfinite(to_table) && on_table(at(to_table))) {
		const Eigen::Vector3d p = at(to_table);
		const double width = to_table * spread;
		// Seen at a grazing angle, a ray covers more along the table.
		const double length = width * ray.direction.norm() / std::abs(ray.direction.y());
		sight.depth = to_table;
		sight.level = table_level(p.x(), p.z(), width, length);
	} else if (to_floor < to_wall) {
		sight.depth = to_floor;
		sight.level = floor_level(at(to_floor).x(), at(to_floor).z());
	} else if (std::isfinite(to_wall)) {
		sight.depth = to_wall;
		sight.level = wall_level(at(to_wall).x(), at(to_wall).y(), to_wall * spread);
	} else {
		sight.depth = INFINITY;
		sight.level = background_.level;
	}
	look_at_net(ray, spread, &sight);
	return sight;
}

double Room::table_level(double x, double z, double footprint_x, double footprint_z) const
{
	const double side = table_width / 2, inner = side - line_width;
	double white = stripe(std::abs(x), footprint_x, inner, side);
	white = std::max(white, stripe(z, footprint_z, 0, line_width));
	white = std::max(white, stripe(z, footprint_z, table_length - line_width, table_length));
	white = std::max(white, stripe(x, footprint_x, -middle_line_width / 2, middle_line_width / 2));
	// Lamps above shine brighter on the middle; the surface is a little uneven.
	const double light = 1.06 - 0.05 * (x * x + (z - net_z) * (z - net_z));
	const double grain = 1.5 * noise(40 * x, 40 * z, seed_ + 1) + 2 * noise(4 * x, 4 * z, seed_ + 2);
	return light * mix(table_grey + grain, line_grey, white);
}

double Room::floor_level(double x, double z) const
{
	const double boards = noise(std::floor(x / 0.12), std::floor(z / 1.1 + 0.37 * std::floor(x / 0.12)), seed_ + 3);
	const double texture =
		0.5 * boards + 0.5 * noise(25 * x, 5 * z, seed_ + 4) + 0.3 * noise(3 * x, 3 * z, seed_ + 5);
	// The table's shade.
	const double beyond = std::max(std::abs(x) - table_width / 2, std::abs(z - net_z) - table_length / 2);
	const double shade = 1 - 0.5 / (1 + std::exp(beyond / 0.08));
	return std::max(0.0, shade * (0.8 * background_.level + background_.contrast * texture));
}

// Panels side by side, a rail along their top, rough all over.
double Room::wall_level(double x, double y, double footprint) const
{
	const double panel = std::floor(x / 0.7 + 100.3);
	const double tone = noise(panel + 0.5, 0.5, seed_ + 6);
	const double texture = 0.6 * noise(5.5 * x, 5.5 * y, seed_ + 7) + 0.45 * noise(18 * x, 18 * y, seed_ + 8) +
			       0.3 * noise(60 * x, 60 * y, seed_ + 9);
	const double joint = stripes(x + 0.7 * 100.3, footprint, 0.7, 0.025);
	const double rail = stripe(y, footprint, 0.10, 0.16);
	const double level = background_.level + background_.contrast * (0.8 * tone + 0.8 * texture);
	const double with_joint = level - 0.9 * background_.contrast * joint;
	return std::clamp(mix(with_joint, background_.level + 1.5 * background_.contrast, rail), 0.0, 255.0);
}

void Room::look_at_net(const Ray &ray, double spread, Sight *sight) const
{
	sight->net_depth = reach(ray, 2, net_z);
	if (sight->net_depth >= sight->depth)
		return;
	const Eigen::Vector3d p = ray.origin + sight->net_depth * ray.direction;
	const double footprint = sight->net_depth * spread;
	const double across = stripe(p.x(), footprint, -net_reach, net_reach);
	const double tape = across * stripe(p.y(), footprint, net_height - tape_width, net_height);
	const double threads =
		1 - (1 - stripes(p.x(), footprint, mesh, thread)) * (1 - stripes(p.y(), footprint, mesh, thread));
	const double cloth = across * stripe(p.y(), footprint, 0, net_height - tape_width) * threads;
	sight->net_cover = tape + cloth;
	if (sight->net_cover > 0)
		sight->net_level = (tape * tape_grey + cloth * mesh_grey) / sight->net_cover;
	sight->level = mix(sight->level, sight->net_level, sight->net_cover);
}

bool hidden(const Eigen::Vector3d &centre, const Eigen::Vector3d &point)
{
	const Ray ray = {centre, point - centre};
	const double to_net = reach(ray, 2, net_z), to_table = reach(ray, 1, 0);
	return (to_net < 1 && on_net(ray.origin + to_net * ray.direction)) ||
	       (to_table < 1 && on_table(ray.origin + to_table * ray.direction));
}

} // namespace sim
