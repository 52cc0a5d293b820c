// Which place in the left picture and which in the right one are the ball.
#pragma once

#include "expect.hpp"
#include "side.hpp"

namespace pong
{

// Two centres that are one ball.
struct Match {
	const pong_centre *left, *right;
	pong_point point;
	double doubt; // below 1: this is a ball and nothing else
	double off;   // the part of it that says that the centres are not those of one ball
};

class Matcher
{
public:
	// All of them outlive it.
	Matcher(const pong_rig &rig, const pong_settings &settings, const FollowedFlight &flight, Side side[2]);

	// The best match of all places that both have seen. Amid what else moves a closer look may give them new ones;
	// `windowed` tells that they have looked where the ball is expected. False where no two places are one ball.
	bool match_sides(bool windowed, Match *match);

private:
	struct Best {
		Match match;
		double cost;
	};

	void match_new(const int matched[2], Best *best);
	bool match_places(const Side::Ball &left, const Side::Ball &right, Match *match) const;
	double cost_of(const Match &match, double contrast) const;

	const pong_rig &rig_;
	const pong_settings &settings_;
	Side *const side_;
	const bool firm_; // whether the flight is sure
	Expected expected_;
	bool expecting_; // whether that is known
};

} // namespace pong
