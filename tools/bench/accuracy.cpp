// How exactly the ball's centre is found: the paper's 60 places under several lights, at rest and moving, by every
// method of ours and by OpenCV's, on the same pictures.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>

#include "bound.hpp"
#include "chart.hpp"
#include "commands.hpp"
#include "opencv_way.hpp"
#include "options.hpp"
#include "owned.hpp"
#include "program.hpp"
#include "studio.hpp"

namespace
{

using namespace bench;
using Clock = std::chrono::steady_clock;

struct Condition {
	const char *name, *light;
	double speed; // m/s
};

const Condition conditions[] = {
	{"overhead", "kind = 'overhead'", 0},    {"front", "kind = 'front'", 0},
	{"diffuse", "kind = 'diffuse'", 0},      {"logo", "kind = 'logo'", 0},
	{"specular", "kind = 'specular'", 0},    {"logo+spec", "logo = 0.6\nspecular = 0.5", 0},
	{"side", "towards = [1, 0.6, -0.2]", 0}, {"5 m/s", "kind = 'overhead'", 5},
	{"10 m/s", "kind = 'overhead'", 10},     {"15 m/s", "kind = 'overhead'", 15},
	{"25 m/s", "kind = 'overhead'", 25},
};

struct Method {
	const char *name;
	int ours;    // pong_locate_method, or -1
	Rival rival; // if not ours
};

const Method methods[] = {
	{"gaussian", PONG_LOCATE_GAUSSIAN, {}}, {"centroid", PONG_LOCATE_CENTROID, {}},
	{"edges", PONG_LOCATE_EDGES, {}},       {"photometric", PONG_LOCATE_PHOTOMETRIC, {}},
	{"moments", -1, Rival::moments},        {"minEnclosingCircle", -1, Rival::enclosing_circle},
	{"fitEllipse", -1, Rival::ellipse},     {"HoughCircles", -1, Rival::hough},
};

// What one method did under one condition.
struct Score {
	int shots = 0, centres = 0;
	std::vector<double> errors;              // of the points, m, in space
	double sum[2] = {}, sum2[2] = {};        // of a centre's error, px
	double normalised2 = 0, normalised3 = 0; // errors squared, by their covariances
	std::vector<double> us;
};

struct Settings {
	int seeds = 2, first_seed = 1;
	std::string rig;  // a calibration to locate with; empty: the true one
	std::string only; // this condition; empty: all
	std::string figure;
};

// Both centres of a shot by one method, and the point.
class Trial
{
public:
	Trial(const pong_rig &rig, const Shot &shot, const pong_detection *detections, const double streak[2][3])
		: rig_(rig), shot_(shot), detections_(detections), streak_(streak)
	{
		pong_settings_defaults(PONG_BEST, &settings_);
	}

	void run(const Method &method, const Eigen::Vector3d &truth, Score *score)
	{
		pong_centre centre[2];
		score->shots++;
		bool both = true;
		for (int side = 0; side < 2; side++) {
			const auto begin = Clock::now();
			const bool found = locate(method, static_cast<pong_side>(side), &centre[side]);
			score->us.push_back(std::chrono::duration<double, std::micro>(Clock::now() - begin).count());
			both &= found;
			if (found)
				add_centre(centre[side], shot_.uv[side], score);
		}
		if (both)
			add_point(method, centre, truth, score);
	}

private:
	bool locate(const Method &method, pong_side side, pong_centre *centre)
	{
		const pong_pictures pictures = shot_.pictures(side);
		const pong_detection &detection = detections_[side];
		if (method.ours >= 0) {
			settings_.locate.method = static_cast<pong_locate_method>(method.ours);
			return pong_locate(&rig_.camera[side], &pictures, &detection, streak_[side], &settings_,
					   centre) == PONG_FOUND;
		}
		const int reach = static_cast<int>(detection.size) + 8;
		const cv::Rect where = cv::Rect(static_cast<int>(detection.u) - reach,
						static_cast<int>(detection.v) - reach, 2 * reach, 2 * reach) &
				       cv::Rect(0, 0, shot_.width, shot_.height);
		double uv[2];
		if (!find_by_contour(pictures, where, method.rival, uv))
			return false;
		const double variance = settings_.locate.sigma * settings_.locate.sigma;
		*centre = {uv[0], uv[1], detection.size / 2, {{variance, 0}, {0, variance}}, 0, 0, {}};
		return true;
	}

	static void add_centre(const pong_centre &centre, const double truth[2], Score *score)
	{
		const Eigen::Vector2d error(centre.u - truth[0], centre.v - truth[1]);
		const Eigen::Matrix2d covariance = Eigen::Map<const Eigen::Matrix2d>(&centre.covariance[0][0]);
		score->centres++;
		score->normalised2 += error.dot(covariance.inverse() * error);
		for (int axis = 0; axis < 2; axis++) {
			score->sum[axis] += error[axis];
			score->sum2[axis] += error[axis] * error[axis];
		}
	}

	void add_point(const Method &method, const pong_centre centre[2], const Eigen::Vector3d &truth, Score *score)
	{
		settings_.reconstruct.method =
			method.ours == PONG_LOCATE_GAUSSIAN ? PONG_RECONSTRUCT_LINEAR : PONG_RECONSTRUCT_LIKELY;
		settings_.reconstruct.epipolar = 100; // wrong centres count as errors, not as absent
		settings_.reconstruct.size = 10;
		pong_point point;
		if (!pong_reconstruct(&rig_, &centre[0], &centre[1], &settings_, &point))
			return;
		const Eigen::Vector3d error = Eigen::Map<const Eigen::Vector3d>(point.position) - truth;
		const Eigen::Matrix3d covariance = Eigen::Map<const Eigen::Matrix3d>(&point.covariance[0][0]);
		score->errors.push_back(error.norm());
		score->normalised3 += error.dot(covariance.inverse() * error);
	}

	const pong_rig &rig_;
	const Shot &shot_;
	const pong_detection *detections_;
	const double (*streak_)[3];
	pong_settings settings_;
};

// What a detector would tell: the place to a pixel, the size to a few percent.
void detect_roughly(const Shot &shot, const pong_rig &rig, std::mt19937_64 &random, pong_detection detections[2])
{
	std::uniform_real_distribution<double> uniform(-1, 1);
	for (int side = 0; side < 2; side++) {
		const double size = pong_apparent_size(&rig.camera[side], shot.position.data(), rig.ball.diameter);
		const double u = 0.7 * uniform(random), v = 0.7 * uniform(random);
		detections[side] = {shot.uv[side][0] + u, shot.uv[side][1] + v, size * (1 + 0.07 * uniform(random)),
				    60};
	}
}

Eigen::Vector3d random_velocity(double speed, std::mt19937_64 &random)
{
	std::uniform_real_distribution<double> uniform(-0.5, 0.5);
	const double azimuth = 0.5 * uniform(random), elevation = 0.7 * uniform(random);
	return speed * Eigen::Vector3d(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
				       -std::cos(azimuth) * std::cos(elevation));
}

// Follows the ball through earlier shots as the eye does, to know how it streaks in the last.
class Follower
{
public:
	Follower(const pong_rig &rig, double exposure)
		: rig_(rig), exposure_(exposure),
		  track_((pong_settings_defaults(PONG_BEST, &settings_), pong_track_new(&rig, &settings_, nullptr)))
	{
	}

	// False where too little was seen to know.
	bool expect(double time, const pong_detection detections[2], double streak[2][3]) const
	{
		pong_state recent, now;
		if (pong_track_count(track_.get()) == 1)
			return expect_since(time, detections, streak);
		if (!pong_track_recent_state(track_.get(), &recent) ||
		    !pong_predict_at(&rig_, &recent, utime_of(time), &settings_, &now))
			return false;
		for (int side = 0; side < 2; side++)
			if (!pong_streak(&rig_.camera[side], now.position, now.velocity, exposure_, streak[side]))
				return false;
		return true;
	}

	void add(const Shot &shot, const pong_detection detections[2])
	{
		double streak[2][3];
		const bool known = expect(shot.time, detections, streak);
		pong_centre centre[2];
		for (int side = 0; side < 2; side++) {
			const pong_pictures pictures = shot.pictures(static_cast<pong_side>(side));
			if (!pong_locate(&rig_.camera[side], &pictures, &detections[side],
					 known ? streak[side] : nullptr, &settings_, &centre[side]))
				return;
		}
		pong_point point = {};
		if (!pong_reconstruct(&rig_, &centre[PONG_LEFT], &centre[PONG_RIGHT], &settings_, &point))
			return;
		point.utime = utime_of(shot.time);
		pong_track_push(track_.get(), &point);
		last_ = point;
	}

private:
	bool expect_since(double time, const pong_detection detections[2], double streak[2][3]) const
	{
		const double seconds = static_cast<double>(utime_of(time) - last_.utime) * 1e-6;
		for (int side = 0; side < 2; side++)
			if (!pong_streak_since(&rig_.camera[side], last_.position, seconds, &detections[side],
					       exposure_, streak[side]))
				return false;
		return true;
	}

	static int64_t utime_of(double time)
	{
		return 1000000 + std::llround(1e6 * time);
	}

	const pong_rig &rig_;
	double exposure_;
	pong_settings settings_;
	pong::OwnedTrack track_;
	pong_point last_ = {};
};

const int shots_before = 5;
const double frame_rate = 110; // Hz

// What is to be located, and the way that led there.
std::vector<Shot> take_shots(Studio &studio, const Eigen::Vector3d &position, const Eigen::Vector3d &velocity)
{
	if (velocity.norm() > 0)
		return studio.follow(position, velocity, shots_before, frame_rate);
	std::vector<Shot> one(1);
	if (!studio.take(position, velocity, &one[0]))
		one.clear();
	return one;
}

void measure_place(Studio &studio, const pong_rig &rig, const std::vector<Shot> &shots, double exposure,
		   std::mt19937_64 &random, Score scores[std::size(methods)])
{
	Follower follower(rig, exposure);
	pong_detection detections[2];
	for (size_t i = 0; i + 1 < shots.size(); i++) {
		detect_roughly(shots[i], studio.rig(), random, detections);
		follower.add(shots[i], detections);
	}
	detect_roughly(shots.back(), studio.rig(), random, detections);
	double streak[2][3];
	if (!follower.expect(shots.back().time, detections, streak))
		std::fill_n(&streak[0][0], 6, 0.0);
	Trial trial(rig, shots.back(), detections, streak);
	for (size_t i = 0; i < std::size(methods); i++)
		trial.run(methods[i], shots.back().position, &scores[i]);
}

pong_rig load_rig(const std::string &path)
{
	pong_rig rig;
	pong_error error;
	if (pong_rig_load(path.c_str(), &rig, &error) < 0)
		throw pong::Failure(error.text);
	return rig;
}

// `bound` has the Cramer-Rao bounds of the first seed's places.
void measure(const Condition &condition, const Settings &settings, Score scores[std::size(methods)], Score *bound)
{
	const sim::Scene scene = sim::parse_scene(pong::format("[light]\n%s\n", condition.light), condition.name);
	sim::Scene quiet = scene;
	quiet.picture.sensor.noise = false;
	Studio still(quiet, static_cast<uint64_t>(settings.first_seed));
	for (int seed = settings.first_seed; seed < settings.first_seed + settings.seeds; seed++) {
		Studio studio(scene, static_cast<uint64_t>(seed));
		const pong_rig rig = settings.rig.empty() ? studio.rig() : load_rig(settings.rig);
		std::mt19937_64 random(static_cast<uint64_t>(seed));
		std::uniform_real_distribution<double> shift(-0.005, 0.005);
		for (const Eigen::Vector3d &place : sim::sixty_places()) {
			const double x = shift(random), y = std::abs(shift(random)), z = shift(random);
			const Eigen::Vector3d position = place + Eigen::Vector3d(x, y, z);
			const Eigen::Vector3d velocity = random_velocity(condition.speed, random);
			const std::vector<Shot> shots = take_shots(studio, position, velocity);
			if (shots.empty() || pong::stop_requested())
				continue;
			measure_place(studio, rig, shots, scene.picture.exposure, random, scores);
			const double least =
				seed == settings.first_seed
					? position_bound(scene, still, shots.back().position, shots.back().velocity)
					: NAN;
			if (std::isfinite(least)) {
				bound->errors.push_back(least);
			}
		}
	}
}

double mean(const std::vector<double> &values)
{
	double sum = 0;
	for (const double value : values)
		sum += value;
	return values.empty() ? NAN : sum / static_cast<double>(values.size());
}

double median(std::vector<double> values)
{
	if (values.empty())
		return NAN;
	std::sort(values.begin(), values.end());
	return values[values.size() / 2];
}

std::string name_of(const Condition &condition)
{
	std::string name = condition.name;
	std::replace(name.begin(), name.end(), ' ', '_');
	return name;
}

void print_row(const Condition &condition, const Method &method, const Score &score)
{
	const double n = std::max(score.centres, 1);
	const size_t points = score.errors.size();
	const double most = points > 0 ? *std::max_element(score.errors.begin(), score.errors.end()) : NAN;
	const double bias[2] = {score.sum[0] / n, score.sum[1] / n};
	const auto spread = [&](int axis) { return std::sqrt(score.sum2[axis] / n - bias[axis] * bias[axis]); };
	printf("%-10s %-18s %5d %5zu %7.3f %8.3f %7.3f %7.3f %6.3f %6.3f %7.2f %7.2f %7.1f\n",
	       name_of(condition).c_str(), method.name, score.shots, points, 1e3 * mean(score.errors), 1e3 * most,
	       bias[0], bias[1], spread(0), spread(1), score.normalised2 / n,
	       score.normalised3 / static_cast<double>(std::max<size_t>(points, 1)), median(score.us));
}

// How the errors of balls at rest are distributed, all lights together.
void draw_errors(const std::string &path, std::vector<double> errors[std::size(methods)])
{
	const char *const colours[] = {"#c23b22", "#e39b21", "#2d8a4e", "#1668b8",
				       "#8a6d2d", "#7a4fb0", "#b0508f", "#777"};
	const double widest = 8; // mm
	std::vector<Line> lines;
	for (size_t i = 0; i < std::size(methods); i++) {
		const double shots = static_cast<double>(errors[i].size());
		std::sort(errors[i].begin(), errors[i].end());
		Line line = {methods[i].name, colours[i], {}, methods[i].ours < 0};
		for (size_t n = 0; n < errors[i].size() && 1e3 * errors[i][n] <= widest; n++)
			line.points.push_back({1e3 * errors[i][n], 100 * static_cast<double>(n + 1) / shots});
		lines.push_back(line);
	}
	write_chart(path, "Balls at rest under seven lights: points with an error of at most ...",
		    {"error in space, mm", 0, widest, 1}, {"points, %", 0, 100, 20}, lines);
}

} // namespace

int bench::accuracy(int argc, char **argv)
{
	Settings settings;
	pong::Options options(
		"pongeye-bench accuracy",
		"Locate rendered balls at the paper's 60 places by every method, at rest and moving:\nthose as a track "
		"of five earlier pairs tells their velocity. Last, the least that noise allows.",
		"  $ pongeye-bench accuracy --seeds 1 | head -3\n");
	options.integer("--seeds", "N", "pictures of each place (2)", &settings.seeds, 1, 1000);
	options.integer("--first-seed", "N", "the first seed (1)", &settings.first_seed, 0, 1000000);
	options.text("--rig", "FILE", "a calibration to locate with, instead of the true one", &settings.rig);
	options.text("--figure", "FILE", "also draw how the errors at rest are distributed, as SVG", &settings.figure);
	options.text("--only", "NAME", "only this condition, as the first column names it", &settings.only);
	if (!options.parse(argc, argv))
		return 0;
	const auto chosen = [&](const Condition &condition) {
		return settings.only.empty() || settings.only == name_of(condition);
	};
	if (std::none_of(std::begin(conditions), std::end(conditions), chosen))
		throw pong::UsageError("--only " + settings.only + ": there is no such condition");
	std::vector<double> at_rest[std::size(methods)];
	printf("# light method shots points mean_mm max_mm bias_u bias_v sd_u sd_v nees2 nees3 us\n");
	for (const Condition &condition : conditions) {
		if (pong::stop_requested())
			break;
		if (!chosen(condition))
			continue;
		Score scores[std::size(methods)], bound;
		measure(condition, settings, scores, &bound);
		for (size_t i = 0; i < std::size(methods); i++)
			print_row(condition, methods[i], scores[i]);
		printf("%s Cramer-Rao %zu %zu %.3f - - - - - - - -\n", name_of(condition).c_str(), bound.errors.size(),
		       bound.errors.size(), 1e3 * mean(bound.errors));
		for (size_t i = 0; i < std::size(methods) && condition.speed == 0; i++)
			at_rest[i].insert(at_rest[i].end(), scores[i].errors.begin(), scores[i].errors.end());
		fflush(stdout);
	}
	if (!settings.figure.empty())
		draw_errors(settings.figure, at_rest);
	return 0;
}
