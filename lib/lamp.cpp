// Of a lamp of strength D a matt surface reflects D max(0, n . l). In Legendre polynomials of n . l that is
// D (1/4 + P1/2 + 5/16 P2 - 3/32 P4 + ...) (Ramamoorthi and Hanrahan 2001, doi:10.1364/JOSAA.18.002448, eq. 19, with
// the (2 k + 1) / 4 pi of the addition theorem): the second order tells the fourth. The polynomial of second order has
// the tensor 5/16 D (3/2 l l' - 1/2), whose greatest eigenvalue is 5/16 D, and l its vector.
#include "lamp.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "clones.hpp"

namespace pong
{

namespace
{

const double fourth_part = -0.3; // of the second order: -3/32 over 5/16
// What is fitted of the second order has an error, of grey levels; where that is all there is, there is no lamp. And
// the part by which the centre's errors became least (docs/locate.md).
const double second_error = 12, believed = 0.7;
const float cover_least = 1e-3f;

} // namespace

Lamp lamp_of(const float shade[shading_terms])
{
	const auto term = [&](int i) { return static_cast<double>(shade[i]); };
	Eigen::Matrix3d second; // the terms are nx ny, nx nz, ny nz, nx^2, ny^2
	second << term(7), term(4) / 2, term(5) / 2, term(4) / 2, term(8), term(6) / 2, term(5) / 2, term(6) / 2, 0;
	second.diagonal().array() -= second.trace() / 3;
	Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
	solver.computeDirect(second);
	const double strength = std::max(0.0, solver.eigenvalues()[2]), square = strength * strength;
	const Eigen::Vector3f towards = solver.eigenvectors().col(2).cast<float>();
	const double sure = square / (square + second_error * second_error);
	return {{towards.x(), towards.y(), towards.z()}, static_cast<float>(believed * sure * fourth_part * strength)};
}

// A pixel's slopes by the shading terms are its cover, and that times its normal.
PONG_CLONES void render_lamp(const Lamp &lamp, const SphereBlock &pixels, float level[block])
{
	const float *cover = pixels.slope[geometry_terms], *x = pixels.slope[geometry_terms + 1];
	const float *y = pixels.slope[geometry_terms + 2], *z = pixels.slope[geometry_terms + 3];
	for (int i = 0; i < block; i++) {
		const float along = lamp.towards[0] * x[i] + lamp.towards[1] * y[i] + lamp.towards[2] * z[i];
		const float t = along / (cover[i] > cover_least ? cover[i] : cover_least), t2 = t * t;
		level[i] = cover[i] * lamp.fourth * ((35 * t2 - 30) * t2 + 3) / 8;
	}
}

} // namespace pong
