#include "fit.hpp"

#include <algorithm>
#include <cmath>

#include "follow.hpp"
#include "program.hpp"

namespace predict
{

namespace
{

const int rounds = 12;
const double believed = 4; // flights' worth: what the rig says of coefficients that the flights do not show

struct Coefficient {
	const char *key;
	double pong_ball_spec::*value;
	double pong_ball_spec::*spread;
	int place; // in a state
};

const Coefficient coefficients[] = {
	{"drag", &pong_ball_spec::drag, &pong_ball_spec::drag_sigma, PONG_STATE_DRAG},
	{"magnus", &pong_ball_spec::magnus, &pong_ball_spec::magnus_sigma, PONG_STATE_MAGNUS},
	{"restitution", &pong_ball_spec::restitution, &pong_ball_spec::restitution_sigma, PONG_STATE_RESTITUTION},
	{"friction", &pong_ball_spec::friction, &pong_ball_spec::friction_sigma, PONG_STATE_FRICTION},
	{"grip", &pong_ball_spec::grip, &pong_ball_spec::grip_sigma, PONG_STATE_GRIP},
};

std::vector<pong_state> last_states(const std::vector<RecordedFlight> &flights, const pong_settings &settings,
				    double noise, const pong_rig &rig)
{
	Follower follower(rig, settings);
	std::vector<pong_state> states;
	for (const RecordedFlight &flight : flights) {
		follower.begin();
		for (const pong_point &point : flight.points)
			follower.push(point, noise);
		pong_state state;
		if (follower.state(&state) && state.has_spin)
			states.push_back(state);
	}
	return states;
}

// One round for one coefficient: the mean over the flights, and their spread about it, each flight's own uncertainty
// included.
Fitted maximise(const std::vector<pong_state> &states, const Coefficient &coefficient, const pong_ball_spec &before,
		pong_ball_spec &ball)
{
	const double count = static_cast<double>(states.size()) + believed;
	const double prior = std::pow(ball.*coefficient.spread, 2);
	double mean = believed * before.*coefficient.value / count, information = believed / prior;
	for (const pong_state &state : states)
		mean += state.coefficients[coefficient.place - PONG_STATE_DRAG] / count;
	double variance = believed * std::pow(before.*coefficient.spread, 2) / count;
	for (const pong_state &state : states) {
		const double own = state.covariance[coefficient.place][coefficient.place];
		const double distance = state.coefficients[coefficient.place - PONG_STATE_DRAG] - mean;
		variance += (distance * distance + own) / count;
		information += std::max(1 - own / prior, 0.0) / prior;
	}
	ball.*coefficient.value = mean;
	ball.*coefficient.spread = std::sqrt(variance);
	return {coefficient.key, mean, std::sqrt(variance), 1 / std::sqrt(information)};
}

void maximise_spin(const std::vector<pong_state> &states, const pong_ball_spec &before, pong_ball_spec &ball)
{
	const double count = static_cast<double>(states.size()) + believed;
	for (int axis = 0; axis < 3; axis++) {
		double variance = believed * std::pow(before.spin_sigma[axis], 2) / count;
		for (const pong_state &state : states)
			variance += (std::pow(state.spin[axis], 2) +
				     state.covariance[PONG_STATE_SPIN + axis][PONG_STATE_SPIN + axis]) /
				    count;
		ball.spin_sigma[axis] = std::sqrt(variance);
	}
}

} // namespace

Fit fit(const std::vector<RecordedFlight> &flights, const pong_settings &settings, double noise, pong_rig &rig)
{
	const pong_ball_spec before = rig.ball;
	Fit result;
	for (int round = 0; round < rounds; round++) {
		const auto states = last_states(flights, settings, noise, rig);
		if (states.empty())
			throw pong::Failure("no flight has enough points to fit anything");
		result.coefficients.clear();
		for (const Coefficient &coefficient : coefficients)
			result.coefficients.push_back(maximise(states, coefficient, before, rig.ball));
		maximise_spin(states, before, rig.ball);
		result.flights = states.size();
	}
	std::copy_n(rig.ball.spin_sigma, 3, result.spin_sigma);
	return result;
}

std::string fit_text(const Fit &fit, const pong_table &table)
{
	std::string text = pong::format("# Fitted to %zu flights by pongeye-predict --fit.\n[ball]\n", fit.flights);
	for (const Fitted &one : fit.coefficients)
		text += pong::format("%s = %.6g # +- %.2g\n%s_sigma = %.4g # from flight to flight\n", one.key,
				     one.mean, one.uncertainty, one.key, one.sigma);
	text += pong::format("spin_sigma = [%.1f, %.1f, %.1f]\n", fit.spin_sigma[0], fit.spin_sigma[1],
			     fit.spin_sigma[2]);
	if (table.present)
		text += pong::format("\n[table] # that they bounced on; without this section no ball bounces\n"
				     "length = %g\nwidth = %g\n",
				     table.length, table.width);
	return text;
}

} // namespace predict
