#include "match.hpp"

#include <algorithm>
#include <limits>

#include "camera.hpp"
#include "closer.hpp"
#include "doubt.hpp"
#include "region.hpp"

namespace pong
{

namespace
{

const double doubt_guided = 1;   // at least, of centres that agree because one was looked for where the other tells
const double outline_part = 0.5; // of the doubt that an outline makes: amid others it is covered easily
const double doubtful_distance = 0.1;     // from where the ball is expected is as bad as that, m
const double farthest_doubt = 2;          // it cannot be worse: the ball may be another one,
const double farthest_doubt_unsure = 0.5; // the more so where the flight is not sure
const double infinite = std::numeric_limits<double>::infinity();

} // namespace

Matcher::Matcher(const pong_rig &rig, const pong_settings &settings, const FollowedFlight &flight, Side side[2])
	: rig_(rig), settings_(settings), side_(side), firm_(flight.firm), expecting_(has_reach(flight, &expected_))
{
}

// Of all pairs of centres that can be one ball: by the paper's method the nearest to where it is expected, or else the
// brightest; at best the one of least doubt, near to where it is expected.
double Matcher::cost_of(const Match &match, double contrast) const
{
	const double distance =
		expecting_ ? (vector_of(match.point.position) - vector_of(expected_.state.position)).norm() : 0;
	if (settings_.detect.method == PONG_DETECT_DIFFERENCE)
		return expecting_ ? distance : -contrast;
	const bool amid_others = cluttered(side_);
	const double farthest = !amid_others || firm_ ? farthest_doubt : farthest_doubt_unsure;
	const double unlike = amid_others ? match.off + outline_part * match.doubt : match.doubt;
	return unlike + std::min(distance / doubtful_distance, farthest);
}

// Two places that look like a ball: one ball, if their centres agree.
bool Matcher::match_places(const Side::Ball &left, const Side::Ball &right, Match *match) const
{
	*match = {&left.centre, &right.centre, {}, 0, 0};
	if (!pong_reconstruct(&rig_, match->left, match->right, &settings_, &match->point) ||
	    !in_flight_space(rig_, settings_, match->point.position))
		return false;
	const double guided = left.guided || right.guided ? doubt_guided : 0;
	match->off = std::max(doubt_of_centres(rig_, left.centre, right.centre, match->point), guided);
	match->doubt = std::max(match->off, doubt_of_outline(std::min(left.shown, right.shown)));
	return true;
}

// The best match of two places that are not both among the first so many; if it is better than the best yet.
void Matcher::match_new(const int matched[2], Best *best)
{
	Side &left = side_[PONG_LEFT], &right = side_[PONG_RIGHT];
	for (int l = 0; l < left.count(); l++)
		for (int r = l < matched[PONG_LEFT] ? matched[PONG_RIGHT] : 0; r < right.count(); r++) {
			Match match;
			const bool located = left.is_located(l) && right.is_located(r);
			if (!(located || may_be_one(rig_, left.found(l), right.found(r))) || !left.ball(l) ||
			    !right.ball(r) || !match_places(*left.ball(l), *right.ball(r), &match))
				continue;
			const double cost = cost_of(match, left.found(l).contrast + right.found(r).contrast);
			if (cost < best->cost)
				*best = {match, cost};
		}
}

bool Matcher::match_sides(bool windowed, Match *match)
{
	Best best = {{}, infinite};
	const int nothing[2] = {0, 0};
	match_new(nothing, &best);
	if (cluttered(side_) && !(best.cost < infinite && best.match.doubt < 1)) {
		const int matched[2] = {side_[PONG_LEFT].count(), side_[PONG_RIGHT].count()};
		look_closer(rig_, side_[PONG_LEFT], side_[PONG_RIGHT], windowed && expecting_ ? &expected_ : nullptr,
			    windowed);
		match_new(matched, &best);
	}
	*match = best.match;
	return best.cost < infinite;
}

} // namespace pong
