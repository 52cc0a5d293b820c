// Two people behind the table, made of limbs: they step from side to side and swing their arms.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "room.hpp"

namespace sim
{

// A rounded bar that stands upright in the plane of constant z, and is textured.
struct Limb {
	Eigen::Vector2d from, to; // x, y, m
	double z, radius;         // m
	double level, contrast;   // grey levels
	double pattern;           // tells clothes apart
};

constexpr double people_z = 3.9; // nobody stands nearer, m

// How somebody moves, and what they wear.
struct Person {
	double x, z, height;             // m
	double pace, sway;               // steps from side to side: turns/s, m
	double swing;                    // of the arms: turns/s
	double step, arms;               // at time 0, turns
	double shirt, trousers, pattern; // grey levels; the pattern tells clothes apart
};

// They look and move otherwise in every world; the first stands nearest.
class People
{
public:
	People(int count, uint64_t seed);

	// Far limbs first.
	std::vector<Limb> limbs_at(double time) const;

private:
	std::vector<Person> persons_;
};

// What a point (x, y) of a limb's plane shows of it: how much of it is covered, 0 to 1, where `softness` is the width
// over which the edge fades, m; and the light there.
double look_at_limb(const Limb &limb, const Eigen::Vector2d &point, double softness, double *level);

// Where a ray comes through the plane that a limb stands in.
Eigen::Vector2d on_plane(const Limb &limb, const Ray &ray);

} // namespace sim
