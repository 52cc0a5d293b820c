#include "people.hpp"

#include <algorithm>
#include <cmath>

#include "texture.hpp"

namespace sim
{

namespace
{

using Eigen::Vector2d;

// How somebody moves, and what they wear.
struct Person {
	double x, z, height;        // m
	double pace, sway;          // steps from side to side: turns/s, m
	double swing, shirt, trousers; // arms: turns/s; clothes: grey levels
	uint64_t pattern;
};

const Person persons[] = {
	{-0.62, people_z, 1.60, 0.31, 0.28, 1.1, 118, 30, 11},
	{0.70, people_z + 0.45, 1.74, 0.23, 0.35, 0.8, 44, 92, 23},
};

constexpr double skin = 140;

Vector2d along(double angle, double length)
{
	return {length * std::sin(angle), -length * std::cos(angle)};
}

void add_person(const Person &person, double time, std::vector<Limb> *limbs)
{
	const double step = 2 * M_PI * person.pace * time, arms = 2 * M_PI * person.swing * time, h = person.height;
	const Vector2d hip(person.x + person.sway * std::sin(step), floor_y + 0.52 * h);
	const Vector2d neck = hip + Vector2d(0.03 * std::sin(step + 1), 0.30 * h);
	const auto add = [&](const Vector2d &from, const Vector2d &to, double radius, double level, double contrast) {
		limbs->push_back({from, to, person.z, radius, level, contrast, person.pattern + limbs->size()});
	};
	for (const double side : {-1.0, 1.0}) {
		const double stride = 0.12 * side + 0.16 * std::sin(step + side);
		const Vector2d top = hip + Vector2d(0.07 * side, 0), knee = top + along(stride, 0.26 * h);
		add(top, knee, 0.075, person.trousers, 10);
		add(knee, knee + along(0.3 * stride, 0.24 * h), 0.055, person.trousers - 6, 8);
	}
	add(hip, neck - Vector2d(0, 0.05), 0.15, person.shirt, 30);
	add(neck, neck + Vector2d(0, 0.06 * h), 0.05, skin, 6);
	add(neck + Vector2d(0, 0.10 * h), neck + Vector2d(0, 0.13 * h), 0.085, skin, 15);
	for (const double side : {-1.0, 1.0}) {
		const double swing = 0.25 * side + 0.6 * std::sin(arms + 1.3 * side);
		const Vector2d shoulder = neck + Vector2d(0.17 * side, -0.03 * h);
		const Vector2d elbow = shoulder + along(swing, 0.17 * h);
		add(shoulder, elbow, 0.045, person.shirt - 8, 18);
		add(elbow, elbow + along(swing + 0.9 * side * std::abs(std::sin(arms / 2)), 0.15 * h), 0.036, skin, 8);
	}
}

} // namespace

std::vector<Limb> limbs_at(double time, int people)
{
	std::vector<Limb> limbs;
	for (int i = people - 1; i >= 0; i--)
		add_person(persons[i], time, &limbs);
	return limbs;
}

double look_at_limb(const Limb &limb, const Ray &ray, double softness, double *level)
{
	const double t = (limb.z - ray.origin.z()) / ray.direction.z();
	const Vector2d bone = limb.to - limb.from;
	const Vector2d p = ray.origin.head<2>() + t * ray.direction.head<2>() - limb.from;
	const double along_bone = std::clamp(p.dot(bone) / bone.squaredNorm(), 0.0, 1.0);
	const double off = (p - along_bone * bone).norm();
	const double cover = std::clamp((limb.radius - off) / softness + 0.5, 0.0, 1.0);
	if (cover > 0) {
		// Cloth hangs on the body: the texture moves with the limb, and its round side falls into shade.
		const double texture = noise(22 * p.x(), 22 * p.y(), limb.pattern);
		const double round = off / limb.radius;
		*level = (limb.level + limb.contrast * texture) * (1.05 - 0.35 * round * round);
	}
	return cover;
}

} // namespace sim
