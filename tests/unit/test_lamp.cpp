// The border of a lamp's light, told by the second order of the shading.
#include <cmath>
#include <gtest/gtest.h>

#include "lamp.hpp"
#include "light.hpp"

namespace
{

const double strength = 200; // of the lamp, grey levels

// A clamped cosine's Legendre polynomials up to the second, as terms of sphere.hpp, along `l`.
void second_order(const Eigen::Vector3d &l, float shade[pong::shading_terms])
{
	// strength (1/4 + t/2 + 5/16 (3 t^2 - 1) / 2) for t = l . n, turned from the x axis.
	Eigen::Matrix<double, pong::shading_terms, 1> terms = Eigen::Matrix<double, pong::shading_terms, 1>::Zero();
	terms[0] = strength * (1.0 / 4 - 5.0 / 32);
	terms[1] = strength / 2;
	terms[7] = strength * 15.0 / 32;
	const Eigen::Matrix3d turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), l).toRotationMatrix();
	terms = (pong::turn_light(turn) * terms).eval();
	for (int i = 0; i < pong::shading_terms; i++)
		shade[i] = static_cast<float>(terms[i]);
}

// Wholly covered pixels, all with normals of one half of a great circle through the lamp.
void fill(const Eigen::Vector3d &l, pong::SphereBlock *pixels)
{
	const Eigen::Vector3d across = l.unitOrthogonal();
	for (int i = 0; i < pong::block; i++) {
		const double angle = M_PI * (i + 0.5) / pong::block;
		const Eigen::Vector3d n = std::cos(angle) * l + std::sin(angle) * across;
		pixels->slope[pong::geometry_terms][i] = 1;
		for (int axis = 0; axis < 3; axis++)
			pixels->slope[pong::geometry_terms + 1 + axis][i] = static_cast<float>(n[axis]);
	}
}

TEST(Lamp, IsNearerToAClampedCosineThanTheSecondOrder)
{
	for (const Eigen::Vector3d &direction : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(-0.2, 0.9, 0.4),
						 Eigen::Vector3d(0.1, -0.3, 1), Eigen::Vector3d(0, 1, 0)}) {
		const Eigen::Vector3d l = direction.normalized();
		float shade[pong::shading_terms], level[pong::block];
		second_order(l, shade);
		const pong::Lamp lamp = pong::lamp_of(shade);
		EXPECT_NEAR(std::abs(l.dot(Eigen::Vector3f(lamp.towards).cast<double>())), 1, 1e-6);
		pong::SphereBlock pixels = {};
		fill(l, &pixels);
		pong::render_lamp(lamp, pixels, level);
		double without = 0, with = 0;
		for (int i = 0; i < pong::block; i++) {
			const double t = std::cos(M_PI * (i + 0.5) / pong::block);
			const double second = strength * (1.0 / 4 + t / 2 + 5.0 / 32 * (3 * t * t - 1));
			const double missing = strength * std::max(0.0, t) - second;
			without += missing * missing;
			with += std::pow(missing - static_cast<double>(level[i]), 2);
		}
		EXPECT_LT(with, 0.3 * without);
	}
}

TEST(Lamp, IsNoneWithoutSecondOrder)
{
	const float linear[pong::shading_terms] = {150, 20, -40, 60};
	EXPECT_NEAR(pong::lamp_of(linear).fourth, 0, 1e-6);
	const float noise[pong::shading_terms] = {150, 20, -40, 60, 2, -1, 1, 3, -2};
	EXPECT_NEAR(pong::lamp_of(noise).fourth, 0, 0.1);
}

} // namespace
