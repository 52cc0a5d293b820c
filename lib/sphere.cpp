// Each pixel is (1 - cover) background + cover shade(n), cover a Gaussian step at the outline, n the surface normal,
// and the mean of that over the streak. The shade is a polynomial of n = (nx, ny, nz), nz towards the camera: light of
// any kind on a matt sphere is smooth. The background may be lit otherwise than it was: a shadow, a lamp that flickers.
#include "sphere.hpp"

#include <cmath>
#include <cstring>

#include "clones.hpp"

namespace pong
{

namespace
{

inline float clamp(float x, float low, float high)
{
	return x < low ? low : x > high ? high : x;
}

// The shading terms at a normal: nz * nz is 1 - nx^2 - ny^2, so no term has nz more than once.
inline void shading_basis(float x, float y, float z, float *term)
{
	const float xx = x * x, xy = x * y, yy = y * y;
	term[0] = 1;
	term[1] = x;
	term[2] = y;
	term[3] = z;
	term[4] = xy;
	term[5] = x * z;
	term[6] = y * z;
	term[7] = xx;
	term[8] = yy;
}

// The shade's derivatives by nx, ny, nz, those being taken as independent.
struct Slope {
	float x, y, z;
};

inline Slope shade_slope(const float *s, float x, float y, float z)
{
	return {s[1] + s[4] * y + s[5] * z + 2 * s[7] * x, s[2] + s[4] * x + s[6] * z + 2 * s[8] * y,
		s[3] + s[5] * x + s[6] * y};
}

// The normal distribution at x: its integral and its density, within 5e-4 (Abramowitz and Stegun, 7.1.27).
struct Normal {
	float integral, density;
};

inline Normal normal_distribution(float x)
{
	const float per_sqrt2 = 0.70710678f;
	const float a = clamp(std::abs(x) * per_sqrt2, 0, 8);
	const float p = 1 + a * (0.278393f + a * (0.230389f + a * (0.000972f + a * 0.078108f)));
	const float slope = 0.278393f + a * (2 * 0.230389f + a * (3 * 0.000972f + a * 4 * 0.078108f));
	const float q = 1 / p, q2 = q * q, tail = 0.5f * q2 * q2;
	return {x < 0 ? tail : 1 - tail, 4 * per_sqrt2 * tail * q * slope};
}

const float facing_least = 0.08f; // of nz: at the outline itself the normal's slope is infinite

} // namespace

PONG_CLONES void render_sphere(const SphereParameters &parameters, const Streak &streak, float per_unit,
			       SphereBlock *pixels)
{
	const float *s = parameters.value + geometry_terms, *gain = parameters.value + first_background;
	const float blur = parameters.value[3], per_blur = 1 / blur, share = 1.0f / static_cast<float>(streak.count);
	float behind[block], bare[block];
	for (int i = 0; i < block; i++) {
		behind[i] = pixels->background[i] *
			    (1 + gain[0] + per_unit * (gain[1] * pixels->u[i] + gain[2] * pixels->v[i]));
		bare[i] = 1;
	}
	memcpy(pixels->level, behind, sizeof pixels->level);
	memset(pixels->slope, 0, sizeof pixels->slope);
	for (int place = 0; place < streak.count; place++) {
		const float u = parameters.value[0] + streak.u[place], v = parameters.value[1] + streak.v[place];
		const float size = streak.size[place], radius = size * parameters.value[2], per_radius = 1 / radius;
		for (int i = 0; i < block; i++) {
			const float du = pixels->u[i] - u, dv = pixels->v[i] - v;
			const float r = std::sqrt(du * du + dv * dv + 1e-6f), per_r = 1 / r;
			const float depth = radius - r, t = depth * per_blur;
			const Normal step = normal_distribution(t);
			const float cover = step.integral;
			// What is covered of the blurred pixel lies this deep inside of the outline, on average.
			const float mean_depth = depth + blur * step.density / (cover + 1e-6f);
			const float e = clamp(1 - mean_depth * per_radius, 0, 1);
			const float x = e * du * per_r, y = e * dv * per_r, zz = 1 - e * e;
			const float z = std::sqrt(zz > 0 ? zz : 0);
			float term[shading_terms], shade = 0;
			shading_basis(x, y, z, term);
			for (int k = 0; k < shading_terms; k++)
				shade += s[k] * term[k];
			const Slope by = shade_slope(s, x, y, z);
			const float per_z = 1 / (z > facing_least ? z : facing_least);
			const float part = share * cover, over = shade - behind[i];
			const float edge = share * step.density * per_blur * over;
			// What is bare of it lies blur density / (1 - cover) farther outside, where the background is
			// another.
			const float rise = (pixels->rise_u[i] * du + pixels->rise_v[i] * dv) * per_r;
			bare[i] -= part;
			pixels->level[i] += part * over + share * blur * step.density * rise;
			pixels->slope[0][i] += edge * du * per_r + part * per_radius * (by.z * x * per_z - by.x);
			pixels->slope[1][i] += edge * dv * per_r + part * per_radius * (by.z * y * per_z - by.y);
			pixels->slope[2][i] +=
				size * (edge + part * per_radius * (by.z * e * e * per_z - by.x * x - by.y * y));
			pixels->slope[3][i] -= edge * t;
			for (int k = 0; k < shading_terms; k++)
				pixels->slope[geometry_terms + k][i] += part * term[k];
		}
	}
	for (int i = 0; i < block; i++) {
		const float seen = bare[i] * pixels->background[i];
		pixels->slope[first_background][i] = seen;
		pixels->slope[first_background + 1][i] = seen * per_unit * pixels->u[i];
		pixels->slope[first_background + 2][i] = seen * per_unit * pixels->v[i];
	}
}

void NormalEquations::clear()
{
	memset(this, 0, sizeof *this);
}

// The sum of products, in lanes.
static inline void add_lanes(const float a[block], const float b[block], float out[NormalEquations::lanes])
{
	const int lanes = NormalEquations::lanes;
	float sum[lanes] = {};
	for (int i = 0; i < block; i += lanes)
		for (int lane = 0; lane < lanes; lane++)
			sum[lane] += a[i + lane] * b[i + lane];
	for (int lane = 0; lane < lanes; lane++)
		out[lane] += sum[lane];
}

PONG_CLONES static void add_products(const SphereBlock &pixels, const float weight[block], const float residual[block],
				     NormalEquations *sums)
{
	float(*out)[NormalEquations::lanes] = sums->normal;
	for (int k = 0; k < sphere_parameters; k++) {
		float weighted[block];
		for (int i = 0; i < block; i++)
			weighted[i] = weight[i] * pixels.slope[k][i];
		add_lanes(weighted, residual, sums->right[k]);
		for (int j = k; j < sphere_parameters; j++)
			add_lanes(weighted, pixels.slope[j], *out++);
	}
}

PONG_CLONES static void add_right_side(const SphereBlock &pixels, const float weight[block],
				       const float residual[block], NormalEquations *sums)
{
	float weighted[block];
	for (int i = 0; i < block; i++)
		weighted[i] = weight[i] * residual[i];
	for (int k = 0; k < sphere_parameters; k++)
		add_lanes(weighted, pixels.slope[k], sums->right[k]);
}

PONG_CLONES void change_residual(const SphereBlock &pixels, const float change[sphere_parameters],
				 float residual[block])
{
	for (int k = 0; k < sphere_parameters; k++)
		for (int i = 0; i < block; i++)
			residual[i] -= change[k] * pixels.slope[k][i];
}

void NormalEquations::add_right(const SphereBlock &pixels, const float weight[block], const float residual[block])
{
	add_right_side(pixels, weight, residual, this);
}

void NormalEquations::add(const SphereBlock &pixels, const float weight[block], const float residual[block])
{
	add_products(pixels, weight, residual, this);
}

} // namespace pong
