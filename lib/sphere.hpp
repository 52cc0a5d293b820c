// What a lit ball looks like, pixel by pixel, and how that changes with its place: what the photometric fit needs.
#pragma once

#include <cstddef>

namespace pong
{

const int shading_terms = 9; // the polynomials of the surface normal up to the second order
const int sphere_parameters = 4 + shading_terms;
const int block = 64; // pixels at a time

// The parameters, in their order: the place of the centre, the radius, the half width of the blurred step (all px), and
// the coefficients of the shading terms (grey levels).
struct SphereParameters {
	float value[sphere_parameters];

	float &u()
	{
		return value[0];
	}
	float &v()
	{
		return value[1];
	}
	float &radius()
	{
		return value[2];
	}
	float &blur()
	{
		return value[3];
	}
	const float *shading() const
	{
		return value + 4;
	}
	float *shading()
	{
		return value + 4;
	}
};

// The way of the ball during the exposure, as `count` places about its middle, px.
const int streak_places_max = 24;
struct Streak {
	int count;
	float u[streak_places_max], v[streak_places_max];
};

// Pixels in a plane in which the outline is a circle.
struct SphereBlock {
	float u[block], v[block];
	float background[block];
	// Filled by render_sphere: what is expected, and its derivative by every parameter.
	float level[block];
	float slope[sphere_parameters][block];
};

void render_sphere(const SphereParameters &parameters, const Streak &streak, SphereBlock *pixels);

// normal += sum of weight slope slope', upper triangle, row by row; right += sum of weight residual slope.
const int sphere_normal_size = sphere_parameters * (sphere_parameters + 1) / 2;
void add_normal_equations(const SphereBlock &pixels, const float weight[block], const float residual[block],
			  double normal[sphere_normal_size], double right[sphere_parameters]);

} // namespace pong
