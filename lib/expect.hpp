// What the flight that is followed makes expect of the next pair.
#pragma once

#include "side.hpp"

namespace pong
{

// Where the flight has the ball now, and how sure that is.
struct Expected {
	pong_state state;
	double reach; // it is not farther from there, m
};

struct FollowedFlight {
	pong_point last; // of its points
	int doubtful;    // of them, the last so many

	// When the next pair is exposed:
	int points;        // how many it has
	bool firm;         // whether enough of them were believed by themselves
	double since_last; // us
	bool expecting;    // whether they tell where the ball is:
	pong_state expected;
};

// Where the ball that is followed must be at that time.
bool expected_state(const pong_rig &rig, const pong_track &track, int64_t utime, const pong_settings &settings,
		    pong_state *expected);

// Work out what the flight's points tell of the pair exposed at `utime`.
void look_ahead(const pong_rig &rig, const pong_track &track, int64_t utime, const pong_settings &settings,
		FollowedFlight *flight);

// Amid what else moves, a doubtful ball is nowhere else. One that was seen but once comes to the robot, most likely.
bool has_reach(const FollowedFlight &flight, Expected *expected);

// What each camera is to expect; where something else moved when it last looked, also of a flight that was seen but
// once.
void expect(const pong_rig &rig, const pong_settings &settings, const FollowedFlight &flight, bool amid_others,
	    Expectation expectations[2]);

} // namespace pong
