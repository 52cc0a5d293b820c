// What a lit ball looks like, pixel by pixel, and how that changes with its place: what the photometric fit needs.
#pragma once

namespace pong
{

const int geometry_terms = 4;
const int shading_terms = 9;    // the polynomials of the surface normal up to the second order
const int background_terms = 3; // how light behind the ball has changed: a factor, and its slopes along u and v
const int first_background = geometry_terms + shading_terms;
const int sphere_parameters = first_background + background_terms;
const int block = 64; // pixels at a time

// The parameters, in their order: the place of the centre, the radius, the standard deviation of the blur (all px), the
// coefficients of the shading terms (grey levels), and those of the background's factor (per radius of the start).
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
};

// The way of the ball during the exposure, as `count` places about that in its middle, px, and its size there over
// that.
const int streak_places_max = 24;
struct Streak {
	int count;
	float u[streak_places_max], v[streak_places_max], size[streak_places_max];
};

// Pixels in a plane in which the outline is a circle.
struct SphereBlock {
	float u[block], v[block];
	float background[block];
	float rise_u[block], rise_v[block]; // of the background, grey levels per px
	// Filled by render_sphere: what is expected, and its derivative by every parameter.
	float level[block];
	float slope[sphere_parameters][block];
};

// `per_unit` is what u and v are multiplied with for the background's slopes.
void render_sphere(const SphereParameters &parameters, const Streak &streak, float per_unit, SphereBlock *pixels);

// Sums over pixels, in lanes that are added up at the end: of weight slope slope', its upper triangle row by row, and
// of weight residual slope.
const int sphere_normal_size = sphere_parameters * (sphere_parameters + 1) / 2;
struct NormalEquations {
	static const int lanes = 8;
	float normal[sphere_normal_size][lanes];
	float right[sphere_parameters][lanes];

	void clear();
	void add(const SphereBlock &pixels, const float weight[block], const float residual[block]);
	// Only the second sum.
	void add_right(const SphereBlock &pixels, const float weight[block], const float residual[block]);
};

// Take from the residuals what a change of the parameters adds to the levels.
void change_residual(const SphereBlock &pixels, const float change[sphere_parameters], float residual[block]);

} // namespace pong
