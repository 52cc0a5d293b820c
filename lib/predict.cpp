// The flight to come (paper, section 6): Euler steps from a state to the hit plane, through the bounces.
#include <cmath>
#include <limits>

#include "flight.hpp"
#include "outlook.hpp"

namespace pong
{

namespace
{

const double nan = std::numeric_limits<double>::quiet_NaN();

int64_t utime_of(const pong_state &start, double time)
{
	return start.utime + std::llround(time * 1e6);
}

pong_state state_of(const pong_state &start, const Flight &flight)
{
	pong_state state = {};
	state.utime = utime_of(start, flight.time);
	store(flight.position, state.position);
	store(flight.velocity, state.velocity);
	return state;
}

Flight flight_of(const pong_state &state)
{
	return {0, vector_of(state.position), vector_of(state.velocity)};
}

// The moment, between two ends of a step, at which the ball is on the plane z.
Flight at_plane(const Flight &before, const Flight &after, double z)
{
	const double part = (before.position.z() - z) / (before.position.z() - after.position.z());
	return {before.time + part * (after.time - before.time),
		before.position + part * (after.position - before.position),
		before.velocity + part * (after.velocity - before.velocity)};
}

void add_to_path(pong_prediction &prediction, const pong_state &start, const Flight &flight)
{
	if (prediction.path_count == PONG_PATH_CAPACITY)
		return;
	auto &point = prediction.path[prediction.path_count++];
	point.utime = utime_of(start, flight.time);
	store(flight.position, point.position);
}

pong_prediction nothing_known(int64_t utime)
{
	pong_prediction prediction = {};
	prediction.utime = utime;
	for (auto &row : prediction.hit_covariance)
		for (double &value : row)
			value = nan;
	for (double &value : prediction.spin)
		value = nan;
	return prediction;
}

} // namespace

} // namespace pong

using namespace pong;

int pong_predict(const pong_rig *rig, const pong_state *state, const pong_settings *settings,
		 pong_prediction *prediction)
{
	*prediction = nothing_known(state->utime);
	if (settings->predict.method == PONG_PREDICT_SPIN)
		return look_ahead(*rig, *state, *settings, *prediction) ? PONG_FOUND : PONG_NONE;
	Flight flight = flight_of(*state);
	if (!flight.position.allFinite() || !flight.velocity.allFinite())
		return PONG_NONE;
	const FlightModel model(*rig);
	const auto &how = settings->predict;
	for (int64_t n = 0; n * how.step < how.horizon && !prediction->has_hit; n++) {
		if (flight.time >= prediction->path_count * how.path_step)
			add_to_path(*prediction, *state, flight);
		const Flight before = flight;
		Flight bounce;
		if (model.step_and_bounce(flight, how.step, &bounce) && !prediction->has_bounce) {
			prediction->has_bounce = 1;
			prediction->bounce = state_of(*state, bounce);
		}
		if (before.position.z() > rig->hit_z && flight.position.z() <= rig->hit_z) {
			const Flight hit = at_plane(before, flight, rig->hit_z);
			prediction->has_hit = 1;
			prediction->hit = state_of(*state, hit);
			add_to_path(*prediction, *state, hit);
		}
	}
	return PONG_FOUND;
}

int pong_predict_at(const pong_rig *rig, const pong_state *state, int64_t utime, const pong_settings *settings,
		    pong_state *then)
{
	if (settings->predict.method == PONG_PREDICT_SPIN)
		return look_ahead_to(*rig, *state, utime, *settings, *then) ? PONG_FOUND : PONG_NONE;
	Flight flight = flight_of(*state);
	const double duration = static_cast<double>(utime - state->utime) * 1e-6;
	if (!flight.position.allFinite() || !flight.velocity.allFinite() || duration < 0 ||
	    duration > settings->predict.horizon)
		return PONG_NONE;
	const FlightModel model(*rig);
	const int64_t steps = static_cast<int64_t>(duration / settings->predict.step);
	Flight bounce;
	for (int64_t n = 0; n < steps; n++)
		model.step_and_bounce(flight, settings->predict.step, &bounce);
	model.step_and_bounce(flight, duration - flight.time, &bounce);
	*then = state_of(*state, flight);
	return PONG_FOUND;
}
