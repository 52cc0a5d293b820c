#include "expect.hpp"

#include <algorithm>
#include <cmath>

#include "track.hpp"
#include "window.hpp"

namespace pong
{

namespace
{

const double expected_reach = 0.06;                    // a doubtful ball is not farther from where it is expected, m,
const double expected_sigmas = 2.5;                    // and so many standard deviations;
const double usual_speed = 8, usual_speed_spread = 12; // or, of one that was seen but once, towards the robot, m/s
const double first_speed = 20;                         // of a ball that was seen but once, at most, m/s

// How far from where it is expected the ball may be.
double reach_of(const pong_state &expected)
{
	double variance = 0;
	for (int axis = 0; axis < 3; axis++)
		variance = std::max(variance, expected.covariance[axis][axis]);
	return expected_reach + expected_sigmas * std::sqrt(variance);
}

// Of a flight that was seen but once, how far the ball can be from there is known. Amid people, where it has been is no
// longer fresh: it is to be searched for near there.
bool windows_around_first(const pong_rig &rig, const pong_settings &settings, const FollowedFlight &flight,
			  Expectation expectations[2])
{
	const double metres = first_speed * flight.since_last * 1e-6;
	bool windowed = true;
	for (int side = 0; side < 2; side++)
		windowed = windowed && window_around(rig, static_cast<pong_side>(side), flight.last.position, metres,
						     settings, &expectations[side].window);
	return windowed;
}

} // namespace

bool expected_state(const pong_rig &rig, const pong_track &track, int64_t utime, const pong_settings &settings,
		    pong_state *expected)
{
	pong_state recent;
	return pong_track_recent_state(&track, &recent) && pong_predict_at(&rig, &recent, utime, &settings, expected);
}

void look_ahead(const pong_rig &rig, const pong_track &track, int64_t utime, const pong_settings &settings,
		FollowedFlight *flight)
{
	flight->points = pong_track_count(&track);
	flight->firm = is_firm(track);
	flight->since_last = static_cast<double>(utime - flight->last.utime);
	flight->expecting = expected_state(rig, track, utime, settings, &flight->expected);
}

bool has_reach(const FollowedFlight &flight, Expected *expected)
{
	if (flight.expecting) {
		*expected = {flight.expected, reach_of(flight.expected)};
		return true;
	}
	if (flight.points != 1)
		return false;
	const double seconds = flight.since_last * 1e-6;
	std::copy_n(flight.last.position, 3, expected->state.position);
	expected->state.position[2] -= usual_speed * seconds;
	expected->reach = expected_reach + usual_speed_spread * seconds;
	return true;
}

void expect(const pong_rig &rig, const pong_settings &settings, const FollowedFlight &flight, bool amid_others,
	    Expectation expectations[2])
{
	const pong_state &expected = flight.expected;
	bool windowed = flight.expecting;
	for (int side = 0; side < 2; side++) {
		Expectation &there = expectations[side];
		there.streaked = flight.expecting && pong_streak(&rig.camera[side], expected.position,
								 expected.velocity, there.exposure, there.streak);
		there.seen_once = flight.points == 1;
		there.seconds = flight.since_last * 1e-6;
		std::copy_n(flight.last.position, 3, there.position);
		windowed =
			windowed && window_around(rig, static_cast<pong_side>(side), expected, settings, &there.window);
	}
	if (!flight.expecting && flight.points == 1 && amid_others)
		windowed = windows_around_first(rig, settings, flight, expectations);
	for (int side = 0; side < 2; side++)
		expectations[side].windowed = windowed;
}

} // namespace pong
