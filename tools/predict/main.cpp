// pongeye-predict: where and when a flight can be hit, from any tracker's points.
#include <cmath>
#include <cstring>
#include <fstream>
#include <iostream>

#include "fit.hpp"
#include "follow.hpp"
#include "options.hpp"
#include "points.hpp"
#include "program.hpp"
#include "table.hpp"

namespace
{

struct Arguments {
	int profile = PONG_BEST;
	double hit_plane = 0, noise = 0, ahead = 0, at = 0;
	bool has_hit_plane = false, has_ahead = false, has_at = false;
	std::string rig, fit;
};

const char *const columns =
	"flight t n hit_t hit_x hit_y hit_z hit_vx hit_vy hit_vz hit_st hit_sx hit_sy bounce_t bounce_x "
	"bounce_z";
const char *const ahead_columns = " ahead_x ahead_y ahead_z ahead_sx ahead_sy ahead_sz";

double sigma(double variance)
{
	return variance > 0 ? std::sqrt(variance) : NAN;
}

double seconds(int64_t utime)
{
	return static_cast<double>(utime) * 1e-6;
}

void add_vector(pong::TableWriter &table, const double vector[3])
{
	for (int axis = 0; axis < 3; axis++)
		table.add(vector[axis]);
}

void add_hit(pong::TableWriter &table, const pong_prediction &prediction)
{
	if (!prediction.has_hit) {
		table.add_absent(10);
		return;
	}
	table.add(seconds(prediction.hit.utime));
	add_vector(table, prediction.hit.position);
	add_vector(table, prediction.hit.velocity);
	table.add(sigma(prediction.hit_covariance[3][3]));
	table.add(sigma(prediction.hit_covariance[0][0]));
	table.add(sigma(prediction.hit_covariance[1][1]));
}

void add_bounce(pong::TableWriter &table, const pong_prediction &prediction)
{
	if (!prediction.has_bounce) {
		table.add_absent(3);
		return;
	}
	table.add(seconds(prediction.bounce.utime));
	table.add(prediction.bounce.position[0]);
	table.add(prediction.bounce.position[2]);
}

void add_ahead(pong::TableWriter &table, const predict::Follower &follower, int64_t utime)
{
	pong_state expected;
	if (!follower.expect(utime, &expected)) {
		table.add_absent(6);
		return;
	}
	add_vector(table, expected.position);
	for (int axis = 0; axis < 3; axis++)
		table.add(expected.has_spin ? sigma(expected.covariance[axis][axis]) : NAN);
}

void predict_rows(predict::PointReader &reader, const Arguments &arguments, const pong_rig &rig,
		  const pong_settings &settings)
{
	const bool ahead = arguments.has_ahead || arguments.has_at;
	pong::TableWriter table("-", std::string(columns) + (ahead ? ahead_columns : ""));
	predict::Follower follower(rig, settings);
	predict::Row row;
	pong_prediction prediction;
	while (!pong::stop_requested() && reader.next(&row)) {
		if (row.begins_flight)
			follower.begin();
		follower.push(row.point, arguments.noise);
		if (!follower.predict(&prediction))
			prediction.has_hit = prediction.has_bounce = 0;
		table.add(row.flight);
		table.add(seconds(row.point.utime));
		table.add(static_cast<int64_t>(follower.count()));
		add_hit(table, prediction);
		add_bounce(table, prediction);
		if (ahead)
			add_ahead(table, follower,
				  arguments.has_at ? std::llround(1e6 * arguments.at)
						   : row.point.utime + std::llround(1e6 * arguments.ahead));
		table.end_row();
	}
	for (const std::string &column : reader.ignored())
		pong::say("column '" + column + "' is unknown here and was not used");
	if (reader.skipped() > 0)
		pong::say(pong::format(
			"%lld rows were skipped: a number was absent or not finite, or the time did not go on",
			static_cast<long long>(reader.skipped())));
}

std::string fit_text(const Arguments &arguments, const pong_settings &settings, pong_rig rig)
{
	const auto flights = predict::read_flights(arguments.fit);
	const predict::Fit fit = predict::fit(flights, settings, arguments.noise, rig);
	return predict::fit_text(fit, rig.table);
}

bool parse(int argc, char **argv, Arguments &arguments)
{
	pong::Options options(
		"pongeye-predict",
		"Predict flights from any tracker's points: a table `t x y z` on stdin, a row on stdout after "
		"every point.",
		"  $ pongeye-predict --fit recorded.txt > ball.toml    # [ball] and [table], for rig.toml too\n"
		"  $ pongeye-predict --rig ball.toml --ahead 0.2 < flights.txt\n"
		"  # flight t n hit_t hit_x hit_y hit_z ...\n"
		"  0 0.000000 1 - - - - - - - - - - - - - - - - - - -\n"
		"  0 0.010000 2 0.323404 0.000000 0.123607 0.000000 ...\n");
	options.choice("--profile", {"paper", "best"}, "the published method, or what measures best (best)",
		       &arguments.profile);
	options.number("--hit-plane", "Z", "the plane on which the robot hits, m (0, or the rig's)",
		       &arguments.hit_plane, -100, 100);
	options.number("--ahead", "S", "also the position expected so long after each point, s", &arguments.ahead, 0,
		       10);
	options.number("--at", "T", "also the position expected at this time, s", &arguments.at, -1e12, 1e12);
	options.number("--noise", "METRES",
		       "standard deviation of the points where the table has no sx sy sz (found out from the points)",
		       &arguments.noise, 1e-6, 10);
	options.text("--rig", "FILE", "ball, table, hit plane and settings; cameras are not needed", &arguments.rig);
	options.text("--fit", "FLIGHTS", "fit the coefficients to these recorded flights, and write them as TOML",
		     &arguments.fit);
	if (!options.parse(argc, argv))
		return false;
	arguments.has_hit_plane = options.given("--hit-plane");
	arguments.has_ahead = options.given("--ahead");
	arguments.has_at = options.given("--at");
	return true;
}

int run(int argc, char **argv)
{
	Arguments arguments;
	if (!parse(argc, argv, arguments))
		return 0;
	pong_rig rig;
	pong_settings settings;
	pong_error error;
	pong_rig_defaults(&rig);
	pong_settings_defaults(static_cast<pong_profile>(arguments.profile), &settings);
	if (!arguments.rig.empty() && (pong_rig_load_flight(arguments.rig.c_str(), &rig, &error) < 0 ||
				       pong_settings_load(arguments.rig.c_str(), &settings, &error) < 0))
		throw pong::Failure(error.text);
	if (arguments.has_hit_plane)
		rig.hit_z = arguments.hit_plane;
	if (!arguments.fit.empty()) {
		printf("%s", fit_text(arguments, settings, rig).c_str());
		return 0;
	}
	std::ios::sync_with_stdio(false);
	predict::PointReader reader(std::cin, "stdin");
	predict_rows(reader, arguments, rig, settings);
	return 0;
}

} // namespace

int main(int argc, char **argv)
{
	return pong::run_program("pongeye-predict", argc, argv, run);
}
