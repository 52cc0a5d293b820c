// pongeye-bench prediction: how well the hit is predicted, ours beside the paper's way, others' and the bound.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include <Eigen/Dense>

#include "chart.hpp"
#include "commands.hpp"
#include "launches.hpp"
#include "options.hpp"
#include "predict/follow.hpp"
#include "prediction_rivals.hpp"
#include "program.hpp"
#include "recorded.hpp"

namespace bench
{

namespace
{

const double cuts[] = {0.4, 0.3, 0.2, 0.1, 0.0}; // s before the hit
const int cut_count = 5, figure_cut = 2;
const size_t least_points = 3, figure_flight = 27;

enum Method { OURS, PAPER, KALMAN, LEAST_SQUARES, METHODS };
const char *const method_names[] = {"ours", "paper", "kalman-spin", "drag-only"};

// Of one method at one cut. A prediction that is missing is counted, and in no mean.
struct Score {
	std::vector<double> distances; // on the hit plane, m
	double time = 0;               // sum of absolute errors, s
	double normalised = 0;         // sum of squared errors over their covariance, by the three dimensions
	double bound_distance = 0, bound_time = 0; // sums over the same flights
	int missing = 0;
};

using Scores = Score[METHODS][cut_count];

struct Experiment {
	LaunchSettings launches;
	int rounds = 6;
	sim::Rig sim_rig = sim::make_rig({});
	pong_rig rig;
	double seconds = 0; // spent in the library's best profile
	int64_t points = 0; // that it was given
};

void score_guess(Score &score, const std::optional<Guess> &guess, double first_time, const Launch &launch,
		 const Bound &bound)
{
	if (!guess) {
		score.missing++;
		return;
	}
	const sim::Hit &truth = *launch.flight.hit();
	score.distances.push_back((guess->position - truth.position).head<2>().norm());
	score.time += std::abs(first_time + guess->time - truth.time);
	score.bound_distance += bound.distance;
	score.bound_time += bound.time;
}

std::optional<Guess> guess_of(const pong_prediction &prediction, int64_t first_utime)
{
	if (!prediction.has_hit)
		return std::nullopt;
	return Guess{Eigen::Map<const Eigen::Vector3d>(prediction.hit.position),
		     static_cast<double>(prediction.hit.utime - first_utime) * 1e-6};
}

// Squared error over its covariance, for x, y and time, each 1 on average where the covariance is true.
double normalised_error(const pong_prediction &prediction, const Guess &guess, double first_time, const Launch &launch)
{
	const sim::Hit &truth = *launch.flight.hit();
	const Eigen::Vector3d error(guess.position.x() - truth.position.x(), guess.position.y() - truth.position.y(),
				    first_time + guess.time - truth.time);
	const int place[] = {0, 1, 3};
	Eigen::Matrix3d covariance;
	for (int i = 0; i < 3; i++)
		for (int j = 0; j < 3; j++)
			covariance(i, j) = prediction.hit_covariance[place[i]][place[j]];
	return error.dot(covariance.ldlt().solve(error)) / 3;
}

// One flight's points through the library, a prediction after each, as a robot would.
void score_library(Experiment &experiment, Method method, const Launch &launch, const std::vector<pong_point> &points,
		   const Bound bounds[], Scores &scores)
{
	pong_settings settings;
	pong_settings_defaults(method == OURS ? PONG_BEST : PONG_PAPER, &settings);
	predict::Follower follower(experiment.rig, settings);
	const double first_time = launch.times[static_cast<size_t>(points[0].frame)];
	pong_prediction prediction = {};
	size_t used = 0;
	const auto begin = std::chrono::steady_clock::now();
	for (int cut = 0; cut < cut_count; cut++) {
		const double latest = launch.flight.hit()->time - cuts[cut];
		for (; used < points.size() && launch.times[static_cast<size_t>(points[used].frame)] <= latest;
		     used++) {
			follower.push(points[used], 0);
			if (!follower.predict(&prediction))
				prediction.has_hit = 0;
		}
		const auto guess = used < least_points ? std::nullopt : guess_of(prediction, points[0].utime);
		Score &score = scores[method][cut];
		score_guess(score, guess, first_time, launch, bounds[cut]);
		if (guess && method == OURS)
			score.normalised += normalised_error(prediction, *guess, first_time, launch);
	}
	if (method != OURS)
		return;
	experiment.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
	experiment.points += static_cast<int64_t>(used);
}

void score_rivals(const Experiment &experiment, const Launch &launch, const std::vector<pong_point> &points,
		  const Bound bounds[], Scores &scores)
{
	KalmanFilter filter(spread_of(experiment.launches).spin);
	const double first_time = launch.times[static_cast<size_t>(points[0].frame)];
	size_t used = 0;
	for (int cut = 0; cut < cut_count; cut++) {
		const double latest = launch.flight.hit()->time - cuts[cut];
		for (; used < points.size() && launch.times[static_cast<size_t>(points[used].frame)] <= latest; used++)
			filter.add(points[used]);
		score_guess(scores[KALMAN][cut], filter.guess(), first_time, launch, bounds[cut]);
		score_guess(scores[LEAST_SQUARES][cut],
			    least_squares({points.begin(), points.begin() + static_cast<std::ptrdiff_t>(used)}),
			    first_time, launch, bounds[cut]);
	}
}

// What is known of the launches' physics before the first of them flies, as a rig.toml would say it.
void tell_rig(const LaunchSettings &settings, pong_rig &rig)
{
	pong_ball_spec &ball = rig.ball;
	const sim::Coefficients mean;
	const Spread spread = spread_of(settings);
	ball.drag = mean.drag;
	ball.drag_sigma = spread.drag;
	ball.drag_by_spin = 0;
	ball.magnus = mean.magnus;
	ball.magnus_sigma = spread.magnus;
	ball.magnus_saturation = 0;
	ball.restitution = mean.restitution;
	ball.restitution_sigma = spread.restitution;
	ball.friction = mean.friction;
	ball.friction_sigma = spread.friction;
	ball.grip = ball.grip_sigma = 0;
	rig.table.height_sigma = 0;
	std::fill_n(ball.spin_sigma, 3, spread.spin);
}

void print_scores(const Experiment &experiment, const Scores &scores)
{
	for (int cut = 0; cut < cut_count; cut++)
		for (int method = 0; method < METHODS; method++) {
			const Score &score = scores[method][cut];
			const double count = static_cast<double>(score.distances.size());
			double sum = 0;
			for (const double distance : score.distances)
				sum += distance;
			printf("%g %.1f %s %d %d %.2f %.2f %.2f %.2f %.3f ", experiment.launches.spin, cuts[cut],
			       method_names[method], static_cast<int>(count), score.missing, 100 * sum / count,
			       100 * score.bound_distance / count, 1000 * score.time / count,
			       1000 * score.bound_time / count, sum / score.bound_distance);
			if (method == OURS)
				printf("%.2f\n", score.normalised / count);
			else
				printf("-\n");
		}
}

// Fig. 13: how the errors are distributed.
void draw_errors(const std::string &path, const Scores &scores)
{
	const char *const colours[] = {"#1668b8", "#c23b22", "#2d8a4e", "#8a6d2d"};
	std::vector<Line> lines;
	for (int method = 0; method < METHODS; method++) {
		auto distances = scores[method][figure_cut].distances;
		std::sort(distances.begin(), distances.end());
		Line line = {method_names[method], colours[method], {}, false};
		const double count = static_cast<double>(distances.size() + scores[method][figure_cut].missing);
		for (size_t i = 0; i < distances.size(); i++)
			if (distances[i] <= 0.12)
				line.points.push_back({100 * distances[i], 100 * static_cast<double>(i + 1) / count});
		lines.push_back(line);
	}
	write_chart(path, "Hit position 0.2 s ahead, spin to 30 rev/s: predictions with an error of at most ...",
		    {"error on the hit plane, cm", 0, 12, 2}, {"predictions, %", 0, 100, 20}, lines);
}

// Fig. 12: predictions approach the true flight.
void draw_approach(const std::string &path, const Experiment &experiment, const Launch &launch,
		   const std::vector<pong_point> &points)
{
	const char *const colours[] = {"#d7b5e8", "#a97fd0", "#6f4fb0", "#1668b8"};
	const size_t counts[] = {2, 4, 8, 16};
	pong_settings settings;
	pong_settings_defaults(PONG_BEST, &settings);
	predict::Follower follower(experiment.rig, settings);
	std::vector<Line> lines;
	for (size_t i = 0; i < points.size(); i++) {
		follower.push(points[i], 0);
		const size_t *const which = std::find(counts, counts + 4, i + 1);
		pong_prediction prediction;
		if (which == counts + 4 || !follower.predict(&prediction))
			continue;
		Line line = {pong::format("from %zu points", i + 1), colours[which - counts], {}, false};
		for (int k = 0; k < prediction.path_count; k++)
			line.points.push_back({prediction.path[k].position[2], prediction.path[k].position[1]});
		lines.push_back(line);
	}
	Line truth = {"true flight", "#000", {}, true};
	for (double time = 0; time < launch.flight.hit()->time; time += 0.002) {
		const sim::Ball ball = launch.flight.at(time);
		truth.points.push_back({ball.position.z(), ball.position.y()});
	}
	lines.push_back(truth);
	write_chart(path, "A flight with spin and its predictions, from the side", {"along the table, z, m", 4, 0, 0.5},
		    {"height, y, m", -0.2, 0.8, 0.2}, lines);
}

void run_flight(Experiment &experiment, const Launch &launch, const std::vector<pong_point> &points, Scores &scores)
{
	Bound bounds[cut_count];
	for (int cut = 0; cut < cut_count; cut++)
		bounds[cut] = prediction_bound(experiment.sim_rig, launch, launch.flight.hit()->time - cuts[cut],
					       experiment.launches);
	score_library(experiment, OURS, launch, points, bounds, scores);
	score_library(experiment, PAPER, launch, points, bounds, scores);
	score_rivals(experiment, launch, points, bounds, scores);
}

void run_range(Experiment experiment, const std::string &figures, Experiment &total)
{
	tell_rig(experiment.launches, experiment.rig);
	Scores scores;
	for (int round = 0; round < experiment.rounds && !pong::stop_requested(); round++) {
		const auto launches = draw_launches(experiment.sim_rig, experiment.launches);
		sim::Random random(experiment.launches.seed++);
		for (const Launch &launch : launches) {
			const auto points =
				measure(experiment.sim_rig, experiment.rig, launch, experiment.launches, random);
			if (points.empty())
				continue;
			run_flight(experiment, launch, points, scores);
			if (!figures.empty() && round == 0 && &launch == &launches[figure_flight])
				draw_approach(figures + "/predict-approach.svg", experiment, launch, points);
		}
	}
	print_scores(experiment, scores);
	if (!figures.empty())
		draw_errors(figures + "/predict-errors.svg", scores);
	total.seconds += experiment.seconds;
	total.points += experiment.points;
}

void run_launches(Experiment &experiment, const std::string &figures)
{
	pong_rig_defaults(&experiment.rig);
	pong_error error;
	if (pong_rig_parse(sim::rig_text(experiment.sim_rig, 0).c_str(), "simulated rig", &experiment.rig, &error) < 0)
		throw pong::Failure(error.text);
	printf("# spin_rev_s before_s method predictions missing position_cm bound_cm time_ms bound_ms over_bound "
	       "nees\n");
	for (const double spin : {5.0, 30.0, 100.0}) {
		experiment.launches.spin = spin;
		run_range(experiment, spin == 30 ? figures : "", experiment);
	}
	pong::say(pong::format("%.0f us a point, prediction to the hit included, over %lld points",
			       1e6 * experiment.seconds / static_cast<double>(experiment.points),
			       static_cast<long long>(experiment.points)));
}

} // namespace

int prediction(int argc, char **argv)
{
	Experiment experiment;
	std::string figures, recorded;
	int folds = 10, seed = 1;
	pong::Options options("pongeye-bench prediction",
			      "Predict the paper's 66 launches in three ranges of spin, beside the paper's way, a "
			      "Kalman filter, least "
			      "squares without spin, and the Cramer-Rao bound; or recorded flights.",
			      "  $ pongeye-bench prediction --rounds 6\n"
			      "  # spin_rev_s before_s method predictions missing position_cm bound_cm time_ms "
			      "bound_ms over_bound nees\n"
			      "  ...");
	options.integer("--rounds", "N", "draw the 66 flights so often (6)", &experiment.rounds, 1, 1000);
	options.integer("--seed", "N", "of the flights and the noise (1)", &seed, 0, 1000000);
	options.number("--noise", "PX", "standard deviation of a ball's centre, per axis, px (0.1)",
		       &experiment.launches.noise, 0.001, 10);
	options.number("--rate", "HZ", "stereo pairs a second (110)", &experiment.launches.rate, 10, 2000);
	options.text("--figures", "DIR", "also draw predict-approach.svg and predict-errors.svg there", &figures);
	options.text("--recorded", "FILE",
		     "predict these recorded flights instead (a table t x y z with a column flight, or parted by blank "
		     "lines)",
		     &recorded);
	options.integer("--folds", "N", "with coefficients fitted on the others, in so many parts; 0: not fitted (10)",
			&folds, 0, 100000);
	if (!options.parse(argc, argv))
		return 0;
	experiment.launches.seed = static_cast<unsigned>(seed);
	if (recorded.empty())
		run_launches(experiment, figures);
	else
		score_recorded(recorded, folds);
	return 0;
}

} // namespace bench
