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
const int radius_term = PONG_LIGHT_TERMS - 1;
static_assert(radius_term == shading_terms);

// What is known of both fits together: the shading of both is the same, and each radius is the ball's.
const int known_terms = shading_terms + 2;
using KnownVector = Eigen::Matrix<double, known_terms, 1>;
using KnownMatrix = Eigen::Matrix<double, known_terms, known_terms>;
using KnownShare = Eigen::Matrix<double, 2 * centre_terms, known_terms>;
using ShadingMatrix = Eigen::Matrix<double, shading_terms, shading_terms>;

// How unlike the light is in the two pictures, standard deviations: by a factor, for cameras are set unlike; by a part
// of the rise of the shading and by grey levels, for surfaces are not quite matt, nor smooth.
const double gain_difference = 0.3;
const double part_difference = 0.1;
const double level_difference = 2;
// How well the radii are known, standard deviations: a part of both, as the rules leave it to balls (40.0 to 40.6 mm,
// ITTF leaflet T3), and px of each.
const double radius_part = 0.0075, radius_error = 0.03;
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

// One camera's.
struct Light {
	TermsVector term;
	TermsMatrix covariance;
	ShareMatrix with_centre;
};

Light load(const pong_light &light)
{
	return {Eigen::Map<const FloatTerms>(light.term).cast<double>(),
		Eigen::Map<const FloatMatrix>(&light.covariance[0][0]).cast<double>(),
		Eigen::Map<const FloatShare>(&light.with_centre[0][0]).cast<double>()};
}

// Of the shading in the two pictures of one ball, the covariance of what it differs by.
ShadingMatrix difference_allowed(const Terms &mean)
{
	const double rise = mean.segment<3>(1).norm();
	const Terms gain = gain_difference * mean;
	ShadingMatrix covariance = gain * gain.transpose();
	covariance.diagonal().array() += level_difference * level_difference + std::pow(part_difference * rise, 2);
	return covariance;
}

// By how much what is known is missed.
KnownVector missed(const Light &left, const Light &right, const Vector2 &radius)
{
	KnownVector out;
	out << (left.term - right.term).head<shading_terms>(), left.term[radius_term] - radius[PONG_LEFT],
		right.term[radius_term] - radius[PONG_RIGHT];
	return out;
}

// The covariance of that.
KnownMatrix missed_covariance(const Light &left, const Light &right, const Vector2 &radius)
{
	const Terms mean = (left.term + right.term).head<shading_terms>() / 2;
	KnownMatrix out;
	out.topLeftCorner<shading_terms, shading_terms>() =
		(left.covariance + right.covariance).topLeftCorner<shading_terms, shading_terms>() +
		difference_allowed(mean);
	out.topRightCorner<shading_terms, 2>() << left.covariance.col(radius_term).head<shading_terms>(),
		-right.covariance.col(radius_term).head<shading_terms>();
	out.bottomLeftCorner<2, shading_terms>() = out.topRightCorner<shading_terms, 2>().transpose();
	out.bottomRightCorner<2, 2>() = radius_part * radius_part * radius * radius.transpose();
	out.diagonal().tail<2>() +=
		Vector2(left.covariance(radius_term, radius_term), right.covariance(radius_term, radius_term)) +
		Vector2::Constant(radius_error * radius_error);
	return out;
}

// The covariance of the centres with that.
KnownShare centres_share(const Light &left, const Light &right)
{
	KnownShare out;
	out << left.with_centre, Vector2::Zero(), -right.with_centre.leftCols<shading_terms>(), Vector2::Zero(),
		right.with_centre.col(radius_term);
	return out;
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

bool join_lights(const pong_rig &rig, const Vector3 &position, pong_centre centre[2], Eigen::Matrix4d *covariance)
{
	if (!centre[PONG_LEFT].light.known || !centre[PONG_RIGHT].light.known)
		return false;
	const Light left = load(centre[PONG_LEFT].light), right = load(centre[PONG_RIGHT].light);
	const Vector2 radius(pong_apparent_size(&rig.camera[PONG_LEFT], position.data(), rig.ball.diameter) / 2,
			     pong_apparent_size(&rig.camera[PONG_RIGHT], position.data(), rig.ball.diameter) / 2);
	const KnownVector differ = missed(left, right, radius);
	const Eigen::LDLT<KnownMatrix> solver(missed_covariance(left, right, radius));
	// Squared, a term, in standard deviations. Where that is much, what is seen is not only light: something covers
	// the ball.
	const double unlike = differ.dot(solver.solve(differ)) / known_terms;
	const double damping = std::max(1.0, unlike), doubt = std::max(1.0, unlike / unlike_usual);
	const KnownShare share = centres_share(left, right);
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
