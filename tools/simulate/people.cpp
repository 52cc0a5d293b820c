#include "people.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "texture.hpp"

namespace sim
{

namespace
{

using Eigen::Vector2d;

constexpr double skin = 140;

// One on each side, as they differ from world to world.
Person draw_person(int number, uint64_t seed)
{
	std::mt19937_64 random(hash(hash(seed) + static_cast<uint64_t>(number)));
	const auto between = [&](double least, double most) {
		return std::uniform_real_distribution<double>(least, most)(random);
	};
	Person person;
	person.x = (number % 2 ? 1 : -1) * between(0.4, 0.8);
	person.z = people_z + 0.45 * number + between(0, 0.4);
	person.height = between(1.5, 1.85);
	person.pace = between(0.15, 0.6);
	person.sway = between(0.15, 0.45);
	person.swing = between(0.5, 1.8);
	person.step = between(0, 1);
	person.arms = between(0, 1);
	person.shirt = between(35, 170);
	person.trousers = between(25, 110);
	person.pattern = between(0, 1);
	return person;
}

// Up and down between -1 and 1 in straight lines, once a unit.
double wave(double x)
{
	return 4 * std::abs(x - std::floor(x) - 0.5) - 1;
}

// Crossing stripes, two sizes of them.
double checks(double x, double y)
{
	return 0.7 * wave(x) * wave(y) + 0.3 * wave(3.3 * x + 0.4 * y);
}

Vector2d along(double angle, double length)
{
	return {length * std::sin(angle), -length * std::cos(angle)};
}

void add_person(const Person &person, double time, std::vector<Limb> *limbs)
{
	const double step = 2 * M_PI * (person.pace * time + person.step), h = person.height;
	const double arms = 2 * M_PI * (person.swing * time + person.arms);
	const Vector2d hip(person.x + person.sway * std::sin(step), floor_y + 0.52 * h);
	const Vector2d neck = hip + Vector2d(0.03 * std::sin(step + 1), 0.30 * h);
	const auto add = [&](const Vector2d &from, const Vector2d &to, double radius, double level, double contrast) {
		limbs->push_back({from, to, person.z, radius, level, contrast,
				  person.pattern + 0.37 * static_cast<double>(limbs->size())});
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

People::People(int count, uint64_t seed)
{
	for (int number = 0; number < count; number++)
		persons_.push_back(draw_person(number, seed));
}

std::vector<Limb> People::limbs_at(double time) const
{
	std::vector<Limb> limbs;
	for (auto person = persons_.rbegin(); person != persons_.rend(); ++person)
		add_person(*person, time, &limbs);
	return limbs;
}

// Cloth hangs on the body: the texture moves with the limb, and its round side falls into shade.
double look_at_limb(const Limb &limb, const Vector2d &point, double softness, double *level)
{
	const Vector2d bone = limb.to - limb.from, p = point - limb.from;
	const double along_bone = std::clamp(p.dot(bone) / bone.squaredNorm(), 0.0, 1.0);
	const double off2 = (p - along_bone * bone).squaredNorm(), outside = limb.radius + softness / 2;
	if (off2 > outside * outside)
		return 0;
	const double texture = checks(11 * p.x() + limb.pattern, 9 * p.y());
	const double shade = 1.05 - 0.35 * off2 / (limb.radius * limb.radius);
	*level = (limb.level + limb.contrast * texture) * shade;
	return std::min((limb.radius - std::sqrt(off2)) / softness + 0.5, 1.0);
}

Vector2d on_plane(const Limb &limb, const Ray &ray)
{
	const double t = (limb.z - ray.origin.z()) / ray.direction.z();
	return ray.origin.head<2>() + t * ray.direction.head<2>();
}

} // namespace sim
