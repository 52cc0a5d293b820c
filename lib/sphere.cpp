// A pixel is partly the ball's and partly the background's:
//
//     level = (1 - cover) background + cover shade(n)
//
// cover is a step at the outline, blurred by lens and pixel with the kernel 15/16 (1 - t^2)^2 / h for |t| = |d| / h < 1
// (close to a Gaussian of standard deviation h / sqrt(7)), d the depth inside of the outline. Its integral, and the
// integral of that, are polynomials; so is the mean depth of the part of a pixel that is covered, which tells the
// normal n there. shade is a polynomial of n = (nx, ny, nz), nz towards the camera: light of any kind on a matt sphere
// is smooth.
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

const float facing_least = 0.08f; // of nz: at the outline itself the normal's slope is infinite

} // namespace

PONG_CLONES void render_sphere(const SphereParameters &parameters, const Streak &streak, SphereBlock *pixels)
{
	const float *s = parameters.value + 4;
	const float radius = parameters.value[2], h = parameters.value[3];
	const float per_radius = 1 / radius, per_h = 1 / h, share = 1.0f / static_cast<float>(streak.count);
	memcpy(pixels->level, pixels->background, sizeof pixels->level);
	memset(pixels->slope, 0, sizeof pixels->slope);
	for (int place = 0; place < streak.count; place++) {
		const float u = parameters.value[0] + streak.u[place], v = parameters.value[1] + streak.v[place];
		for (int i = 0; i < block; i++) {
			const float du = pixels->u[i] - u, dv = pixels->v[i] - v;
			const float r = std::sqrt(du * du + dv * dv + 1e-6f), per_r = 1 / r;
			const float depth = radius - r, t = clamp(depth * per_h, -1, 1), tt = t * t;
			const float cover = 0.5f + t * (15 - tt * (10 - 3 * tt)) * (1.0f / 16);
			const float step = (15.0f / 16) * (1 - tt) * (1 - tt) * per_h;
			const float covered =
				h * (0.15625f + 0.5f * t + tt * (7.5f - tt * (2.5f - 0.5f * tt)) * (1.0f / 16));
			const float mean_depth = depth > h ? depth : covered / (cover + 1e-6f);
			const float e = clamp(1 - mean_depth * per_radius, 0, 1);
			const float x = e * du * per_r, y = e * dv * per_r, zz = 1 - e * e;
			const float z = std::sqrt(zz > 0 ? zz : 0);
			float term[shading_terms], shade = 0;
			shading_basis(x, y, z, term);
			for (int k = 0; k < shading_terms; k++)
				shade += s[k] * term[k];
			const Slope by = shade_slope(s, x, y, z);
			const float per_z = 1 / (z > facing_least ? z : facing_least);
			const float part = share * cover, over = shade - pixels->background[i];
			const float edge = share * step * over;
			pixels->level[i] += part * over;
			pixels->slope[0][i] += edge * du * per_r + part * per_radius * (by.z * x * per_z - by.x);
			pixels->slope[1][i] += edge * dv * per_r + part * per_radius * (by.z * y * per_z - by.y);
			pixels->slope[2][i] += edge + part * per_radius * (by.z * e * e * per_z - by.x * x - by.y * y);
			pixels->slope[3][i] -= edge * t;
			for (int k = 0; k < shading_terms; k++)
				pixels->slope[4 + k][i] += part * term[k];
		}
	}
}

PONG_CLONES void add_normal_equations(const SphereBlock &pixels, const float weight[block], const float residual[block],
				      double normal[sphere_normal_size], double right[sphere_parameters])
{
	const int lanes = 8;
	double *out = normal;
	for (int k = 0; k < sphere_parameters; k++) {
		float weighted[block], sum[lanes] = {};
		for (int i = 0; i < block; i++)
			weighted[i] = weight[i] * pixels.slope[k][i];
		for (int i = 0; i < block; i += lanes)
			for (int lane = 0; lane < lanes; lane++)
				sum[lane] += weighted[i + lane] * residual[i + lane];
		for (int lane = 0; lane < lanes; lane++)
			right[k] += static_cast<double>(sum[lane]);
		for (int j = k; j < sphere_parameters; j++) {
			float product[lanes] = {};
			for (int i = 0; i < block; i += lanes)
				for (int lane = 0; lane < lanes; lane++)
					product[lane] += weighted[i + lane] * pixels.slope[j][i + lane];
			float total = 0;
			for (int lane = 0; lane < lanes; lane++)
				total += product[lane];
			*out++ += static_cast<double>(total);
		}
	}
}

} // namespace pong
