#include "trust.hpp"

#include <algorithm>
#include <cmath>

#include "camera.hpp"

namespace pong
{

namespace
{

const double doubt_alone = 2;         // allowed where no other place looks like a ball
const double doubt_fresh = 3.5;       // and where it has just come: it may lie before something that moves
const double fresh_enough = 12;       // what has just come differs by so much from what was there, grey levels,
const double very_fresh = 20;         // or, where its centres agree less well, by so much
const double off_little = 0.5;        // what agrees so well is a ball, though its outline shows less
const double slow = 2.5;              // people's arms are, m/s
const int slow_points = 3;            // of a flight tell its speed
const int doubtful_most = 8;          // doubtful points in a row: that is an arm
const double error_amid_others = 1.5; // times what the fits tell, of a point amid what else moves
const double error_most = 0.13;       // standard deviation of a doubtful point, m

// By how much what both pictures show there differs from all that was near it before: nothing but a ball comes so soon.
double freshness(const Match &match, const Side side[2])
{
	const pong_centre &left = *match.left, &right = *match.right;
	return std::min(side[PONG_LEFT].freshness(left.u, left.v, left.radius),
			side[PONG_RIGHT].freshness(right.u, right.v, right.radius));
}

Trust trust_amid_others(const Match &match, const Side side[2])
{
	const double fresh = match.doubt < doubt_fresh ? freshness(match, side) : 0;
	if (fresh > fresh_enough && match.off < off_little)
		return Trust::certain;
	if (fresh > very_fresh)
		return match.doubt < 1 ? Trust::certain : Trust::usual;
	// Hands are many, and one person's left is taken for another's right.
	const bool alone = side[PONG_LEFT].count() == 1 && side[PONG_RIGHT].count() == 1;
	return match.doubt < (alone ? doubt_alone : 1) ? Trust::likely : Trust::none;
}

// What is followed moves as an arm does.
bool is_slow(const FollowedFlight &flight)
{
	const double *velocity = flight.expected.velocity;
	return flight.expecting && flight.expected.has_spin && flight.points >= slow_points &&
	       std::hypot(velocity[0], velocity[1], velocity[2]) < slow;
}

// In the direction in which the point is known least, standard deviation, m.
double error_of(const pong_point &point)
{
	const Matrix3 covariance = Eigen::Map<const Matrix3>(&point.covariance[0][0]);
	return std::sqrt(Eigen::SelfAdjointEigenSolver<Matrix3>(covariance, Eigen::EigenvaluesOnly).eigenvalues()[2]);
}

} // namespace

Trust trust_of(const Match &match, const Side side[2], const pong_settings &settings)
{
	if (settings.detect.method == PONG_DETECT_DIFFERENCE)
		return Trust::usual;
	if (cluttered(side))
		return trust_amid_others(match, side);
	return match.doubt < 1 ? Trust::certain : Trust::usual;
}

bool is_hopeless(const Match &match, Trust trust, const FollowedFlight &flight)
{
	if (trust != Trust::none)
		return false;
	if (is_slow(flight))
		return true;
	Expected expected;
	return !(match.off < 1) &&
	       (!has_reach(flight, &expected) || flight.doubtful >= doubtful_most ||
		(vector_of(match.point.position) - vector_of(expected.state.position)).norm() > expected.reach);
}

bool is_hardly_known(const pong_point &point, Trust trust, const pong_settings &settings)
{
	return settings.detect.method != PONG_DETECT_DIFFERENCE && trust != Trust::certain &&
	       error_of(point) > error_most;
}

void count_point(const Match &match, pong_track_event event, FollowedFlight *flight)
{
	const int before = event == PONG_TRACK_BEGUN ? 0 : flight->doubtful;
	flight->doubtful = match.off < 1 ? 0 : before + 1;
	flight->last = match.point;
}

pong_point doubted(const Match &match)
{
	pong_point point = match.point;
	const double factor = error_amid_others * std::max(1.0, match.off * match.off);
	Eigen::Map<Matrix3>(&point.covariance[0][0]) *= factor * factor;
	return point;
}

} // namespace pong
