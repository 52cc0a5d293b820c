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

// A coefficient of a rig: what holds for all flights, and how they differ.
struct Coefficient {
	const char *section, *key; // in rig.toml
	double *mean, *spread;
	int place; // in a state
};

std::vector<Coefficient> coefficients_of(pong_rig &rig)
{
	pong_ball_spec &ball = rig.ball;
	return {
		{"ball", "drag", &ball.drag, &ball.drag_sigma, PONG_STATE_DRAG},
		{"ball", "magnus", &ball.magnus, &ball.magnus_sigma, PONG_STATE_MAGNUS},
		{"ball", "restitution", &ball.restitution, &ball.restitution_sigma, PONG_STATE_RESTITUTION},
		{"ball", "friction", &ball.friction, &ball.friction_sigma, PONG_STATE_FRICTION},
		{"ball", "grip", &ball.grip, &ball.grip_sigma, PONG_STATE_GRIP},
		{"table", "height", &rig.table.height, &rig.table.height_sigma, PONG_STATE_HEIGHT},
	};
}

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
// included. One without spread is held fast.
Fitted maximise(const std::vector<pong_state> &states, const Coefficient &before, const Coefficient &now)
{
	const double prior = std::pow(*now.spread, 2);
	if (!(prior > 0))
		return {now.section, now.key, *now.mean, 0, 0};
	const double count = static_cast<double>(states.size()) + believed;
	double mean = believed * *before.mean / count, information = believed / prior;
	for (const pong_state &state : states)
		mean += state.coefficients[now.place - PONG_STATE_DRAG] / count;
	double variance = believed * std::pow(*before.spread, 2) / count;
	for (const pong_state &state : states) {
		const double own = state.covariance[now.place][now.place];
		const double distance = state.coefficients[now.place - PONG_STATE_DRAG] - mean;
		variance += (distance * distance + own) / count;
		information += std::max(1 - own / prior, 0.0) / prior;
	}
	*now.mean = mean;
	*now.spread = std::sqrt(variance);
	return {now.section, now.key, mean, std::sqrt(variance), 1 / std::sqrt(information)};
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

std::string section_text(const Fit &fit, const std::string &section)
{
	std::string text;
	for (const Fitted &one : fit.coefficients)
		if (one.section == section)
			text += pong::format("%s = %.6g # +- %.2g\n%s_sigma = %.4g # from flight to flight\n", one.key,
					     one.mean, one.uncertainty, one.key, one.sigma);
	return text;
}

} // namespace

Fit fit(const std::vector<RecordedFlight> &flights, const pong_settings &settings, double noise, pong_rig &rig)
{
	pong_rig before = rig;
	const auto old = coefficients_of(before), now = coefficients_of(rig);
	Fit result;
	for (int round = 0; round < rounds; round++) {
		const auto states = last_states(flights, settings, noise, rig);
		if (states.empty())
			throw pong::Failure("no flight has enough points to fit anything");
		result.coefficients.clear();
		for (size_t i = 0; i < now.size(); i++)
			result.coefficients.push_back(maximise(states, old[i], now[i]));
		maximise_spin(states, before.ball, rig.ball);
		result.flights = states.size();
	}
	std::copy_n(rig.ball.spin_sigma, 3, result.spin_sigma);
	return result;
}

std::string fit_text(const Fit &fit, const pong_table &table)
{
	std::string text = pong::format("# Fitted to %zu flights by pongeye-predict --fit.\n[ball]\n", fit.flights) +
			   section_text(fit, "ball") +
			   pong::format("spin_sigma = [%.1f, %.1f, %.1f]\n", fit.spin_sigma[0], fit.spin_sigma[1],
					fit.spin_sigma[2]);
	if (table.present)
		text += pong::format("\n[table] # that they bounced on; without this section no ball bounces\n"
				     "length = %g\nwidth = %g\n",
				     table.length, table.width) +
			section_text(fit, "table");
	return text;
}

} // namespace predict
