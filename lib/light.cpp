// With nine shading terms free in each picture, a ball's centre is uncertain by half more than with the shading known:
// a ball that is brighter on its left looks much like one farther left. Both pictures show the same ball under the
// same light, and a mistake about it moves both centres alike, which hardly moves the point in depth. So the terms of
// both, and the radii, are taken as measurements of the same: a linear step on both fits' joint covariance.
#include "light.hpp"

#include <algorithm>
#include <cmath>

namespace pong
{

namespace
{

using TermsVector = Eigen::Matrix<double, PONG_LIGHT_TERMS, 1>;
using TermsMatrix = Eigen::Matrix<double, PONG_LIGHT_TERMS, PONG_LIGHT_TERMS>;
using ShareMatrix = Eigen::Matrix<double, centre_terms, PONG_LIGHT_TERMS>;

// How unlike the light is in the two pictures, standard deviations: by a factor, for cameras are set unlike; by a part
// of the rise of the shading and by grey levels, for surfaces are not quite matt, nor smooth.
const double gain_difference = 0.3;
const double part_difference = 0.1;
const double level_difference = 2;
const double radius_difference = 0.01; // px, the distances from both cameras being known
// How unlike the light of two pictures usually is at most, squared, a term, in the standard deviations of what is known
// of it; where it is more, the covariance grows with it.
const double unlike_usual = 0.4;
// Of the covariance after the step: a part of it, for the fits' covariances hold much that is common; and of the
// centres' own, as an error of the model that both pictures have alike (docs/locate.md).
const double joined_part = 0.7, common_model_part = 0.2;

// A polynomial of second order in the normal: level + slope . n + n' curve n.
struct Polynomial {
	double level;
	Vector3 slope;
	Matrix3 curve;
};

using Terms = Eigen::Matrix<double, shading_terms, 1>;

Polynomial polynomial_of(const Terms &t)
{
	Polynomial out = {t[0], t.segment<3>(1), Matrix3::Zero()};
	out.curve << t[7], t[4] / 2, t[5] / 2, t[4] / 2, t[8], t[6] / 2, t[5] / 2, t[6] / 2, 0;
	return out;
}

// nz^2 is 1 - nx^2 - ny^2.
Terms terms_of(const Polynomial &p)
{
	const double zz = p.curve(2, 2);
	Terms out;
	out << p.level + zz, p.slope, 2 * p.curve(0, 1), 2 * p.curve(0, 2), 2 * p.curve(1, 2), p.curve(0, 0) - zz,
		p.curve(1, 1) - zz;
	return out;
}

using FloatTerms = Eigen::Matrix<float, PONG_LIGHT_TERMS, 1>;
using FloatMatrix = Eigen::Matrix<float, PONG_LIGHT_TERMS, PONG_LIGHT_TERMS, Eigen::RowMajor>;
using FloatShare = Eigen::Matrix<float, centre_terms, PONG_LIGHT_TERMS, Eigen::RowMajor>;

// One camera's, the radius in multiples of `unit`.
struct Light {
	TermsVector term;
	TermsMatrix covariance;
	ShareMatrix with_centre;
};

Light load(const pong_light &light, double unit)
{
	Light out = {Eigen::Map<const FloatTerms>(light.term).cast<double>(),
		     Eigen::Map<const FloatMatrix>(&light.covariance[0][0]).cast<double>(),
		     Eigen::Map<const FloatShare>(&light.with_centre[0][0]).cast<double>()};
	const int radius = PONG_LIGHT_TERMS - 1;
	out.term[radius] /= unit;
	out.covariance.row(radius) /= unit;
	out.covariance.col(radius) /= unit;
	out.with_centre.col(radius) /= unit;
	return out;
}

// Of the terms of the two pictures of one ball, the covariance of what they differ by.
TermsMatrix difference_allowed(const TermsVector &mean)
{
	const double rise = mean.segment<3>(1).norm();
	TermsVector gain = gain_difference * mean;
	gain[PONG_LIGHT_TERMS - 1] = 0;
	TermsMatrix covariance = gain * gain.transpose();
	covariance.diagonal().array() += level_difference * level_difference + std::pow(part_difference * rise, 2);
	covariance(PONG_LIGHT_TERMS - 1, PONG_LIGHT_TERMS - 1) = radius_difference * radius_difference;
	return covariance;
}

} // namespace

LightMatrix turn_light(const Matrix3 &turn)
{
	LightMatrix out;
	for (int i = 0; i < shading_terms; i++) {
		const Polynomial p = polynomial_of(Terms::Unit(i));
		out.col(i) = terms_of({p.level, turn * p.slope, turn * p.curve * turn.transpose()});
	}
	return out;
}

void store_light(const FoundVector &found, const FoundMatrix &covariance, pong_light *light)
{
	light->known = 1;
	Eigen::Map<FloatTerms>{light->term} = found.tail<PONG_LIGHT_TERMS>().cast<float>();
	Eigen::Map<FloatMatrix>{&light->covariance[0][0]} =
		covariance.bottomRightCorner<PONG_LIGHT_TERMS, PONG_LIGHT_TERMS>().cast<float>();
	Eigen::Map<FloatShare>{&light->with_centre[0][0]} =
		covariance.topRightCorner<centre_terms, PONG_LIGHT_TERMS>().cast<float>();
}

bool join_lights(const pong_camera camera[2], const Vector3 &position, pong_centre centre[2],
		 Eigen::Matrix4d *covariance)
{
	if (!centre[PONG_LEFT].light.known || !centre[PONG_RIGHT].light.known)
		return false;
	const double one = 1; // m; the ratio does not depend on it
	const double ratio = pong_apparent_size(&camera[PONG_RIGHT], position.data(), one) /
			     pong_apparent_size(&camera[PONG_LEFT], position.data(), one);
	const Light left = load(centre[PONG_LEFT].light, 1), right = load(centre[PONG_RIGHT].light, ratio);
	const TermsVector differ = left.term - right.term;
	TermsMatrix spread = left.covariance + right.covariance + difference_allowed((left.term + right.term) / 2);
	const Eigen::LDLT<TermsMatrix> solver(spread);
	// Squared, a term, in standard deviations. Where that is much, what is seen is not only light: something covers
	// the ball.
	const double unlike = differ.dot(solver.solve(differ)) / PONG_LIGHT_TERMS;
	const double damping = std::max(1.0, unlike), doubt = std::max(1.0, unlike / unlike_usual);
	Eigen::Matrix<double, 4, PONG_LIGHT_TERMS> share;
	share << left.with_centre, -right.with_centre;
	const Eigen::Vector4d step = -share * solver.solve(differ) / damping;
	Eigen::Matrix4d before = Eigen::Matrix4d::Zero();
	Matrix2 mean = Matrix2::Zero();
	for (int side = 0; side < 2; side++) {
		const Matrix2 own = Eigen::Map<const Matrix2>(&centre[side].covariance[0][0]);
		before.block<2, 2>(2 * side, 2 * side) = own;
		mean += own / 2;
		centre[side].u += step[2 * side];
		centre[side].v += step[2 * side + 1];
	}
	*covariance = doubt * joined_part * (before - share * solver.solve(share.transpose()) / damping) +
		      common_model_part * mean.replicate<2, 2>();
	return covariance->allFinite();
}

} // namespace pong
