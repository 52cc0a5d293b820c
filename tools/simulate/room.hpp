// The room that does not move: table, net, floor and the wall behind. What a ray from a camera meets.
#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace sim
{

constexpr double table_length = 2.74, table_width = 1.525; // m
constexpr double net_z = table_length / 2, net_height = 0.1525;
constexpr double net_reach = table_width / 2 + 0.1525; // from the middle, m
constexpr double floor_y = -0.76;

struct Background {
	double level = 50;     // mean of the wall and the floor, grey levels
	double contrast = 20;  // of their texture, grey levels
	double distance = 5.5; // of the wall, z, m
};

// A ray: origin + t * direction. With a direction whose depth along the optical axis is 1, t is the depth in metres.
struct Ray {
	Eigen::Vector3d origin, direction;
};

// What a ray meets.
struct Sight {
	double level; // of light, grey levels
	double depth; // t of the first opaque surface; infinity where there is none
	// The net in front of it.
	double net_cover; // how much of the ray's footprint it takes, 0 to 1
	double net_level;
	double net_depth;
};

class Room
{
public:
	Room(const Background &background, uint64_t seed);

	// `spread` is the angle between neighbouring rays, rad: finer detail is averaged.
	Sight look(const Ray &ray, double spread) const;

private:
	double table_level(double x, double z, double footprint_x, double footprint_z) const;
	double floor_level(double x, double z) const;
	double wall_level(double x, double y, double footprint) const;
	void look_at_net(const Ray &ray, double spread, Sight *sight) const;

	Background background_;
	uint64_t seed_;
};

// Whether the table or the net stands between a camera's centre and a point.
bool hidden(const Eigen::Vector3d &centre, const Eigen::Vector3d &point);

} // namespace sim
