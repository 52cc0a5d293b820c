// How exactly the ball's centre is found: the paper's 60 places under several lights, at rest and moving, by every
// method of ours and by OpenCV's, on the same pictures.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>

#include "commands.hpp"
#include "opencv_way.hpp"
#include "options.hpp"
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
	int shots = 0, points = 0, centres = 0;
	double error = 0, error_most = 0;        // m, in space
	double sum[2] = {}, sum2[2] = {};        // of a centre's error, px
	double normalised2 = 0, normalised3 = 0; // errors squared, by their covariances
	double us = 0;
};

struct Settings {
	int seeds, first_seed;
	double velocity_error; // m/s
};

// Both centres of a shot by one method, and the point.
class Trial
{
public:
	Trial(const Studio &studio, const Shot &shot, const pong_detection *detections, const double streak[2][2])
		: studio_(studio), shot_(shot), detections_(detections), streak_(streak)
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
			score->us += std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
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
			return pong_locate(&studio_.rig().camera[side], &pictures, &detection, streak_[side],
					   &settings_, centre) == PONG_FOUND;
		}
		const int reach = static_cast<int>(detection.size) + 8;
		const cv::Rect where = cv::Rect(static_cast<int>(detection.u) - reach,
						static_cast<int>(detection.v) - reach, 2 * reach, 2 * reach) &
				       cv::Rect(0, 0, shot_.width, shot_.height);
		double uv[2];
		if (!find_by_contour(pictures, where, method.rival, uv))
			return false;
		const double variance = settings_.locate.sigma * settings_.locate.sigma;
		*centre = {uv[0], uv[1], detection.size / 2, {{variance, 0}, {0, variance}}};
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
		if (!pong_reconstruct(&studio_.rig(), &centre[0], &centre[1], &settings_, &point))
			return;
		const Eigen::Vector3d error = Eigen::Map<const Eigen::Vector3d>(point.position) - truth;
		const Eigen::Matrix3d covariance = Eigen::Map<const Eigen::Matrix3d>(&point.covariance[0][0]);
		score->points++;
		score->error += error.norm();
		score->error_most = std::max(score->error_most, error.norm());
		score->normalised3 += error.dot(covariance.inverse() * error);
	}

	const Studio &studio_;
	const Shot &shot_;
	const pong_detection *detections_;
	const double (*streak_)[2];
	pong_settings settings_;
};

// What a detector would tell: the place to a pixel, the size to a few percent.
void detect_roughly(const Studio &studio, const Shot &shot, const Eigen::Vector3d &position, std::mt19937_64 &random,
		    pong_detection detections[2])
{
	std::uniform_real_distribution<double> uniform(-1, 1);
	for (int side = 0; side < 2; side++) {
		const double size =
			pong_apparent_size(&studio.rig().camera[side], position.data(), studio.rig().ball.diameter);
		detections[side] = {shot.uv[side][0] + 0.7 * uniform(random), shot.uv[side][1] + 0.7 * uniform(random),
				    size * (1 + 0.07 * uniform(random)), 60};
	}
}

Eigen::Vector3d random_velocity(double speed, std::mt19937_64 &random)
{
	std::uniform_real_distribution<double> uniform(-0.5, 0.5);
	const double azimuth = 0.5 * uniform(random), elevation = 0.7 * uniform(random);
	return speed * Eigen::Vector3d(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
				       -std::cos(azimuth) * std::cos(elevation));
}

void measure(const Condition &condition, const Settings &settings, Score scores[std::size(methods)])
{
	const sim::Scene scene = sim::parse_scene(pong::format("[light]\n%s\n", condition.light), condition.name);
	for (int seed = settings.first_seed; seed < settings.first_seed + settings.seeds; seed++) {
		Studio studio(scene, static_cast<uint64_t>(seed));
		std::mt19937_64 random(static_cast<uint64_t>(seed));
		std::uniform_real_distribution<double> shift(-0.005, 0.005);
		std::normal_distribution<double> velocity_error(0, settings.velocity_error);
		for (const Eigen::Vector3d &place : sim::sixty_places()) {
			const Eigen::Vector3d position =
				place + Eigen::Vector3d(shift(random), std::abs(shift(random)), shift(random));
			const Eigen::Vector3d velocity = random_velocity(condition.speed, random);
			Shot shot;
			if (!studio.take(position, velocity, &shot))
				continue;
			pong_detection detections[2];
			detect_roughly(studio, shot, position, random, detections);
			Eigen::Vector3d believed = velocity;
			double streak[2][2] = {};
			if (condition.speed > 0)
				for (int axis = 0; axis < 3; axis++)
					believed[axis] += velocity_error(random);
			for (int side = 0; side < 2; side++)
				pong_streak(&studio.rig().camera[side], position.data(), believed.data(),
					    condition.speed > 0 ? scene.picture.exposure : 0, streak[side]);
			Trial trial(studio, shot, detections, streak);
			for (size_t i = 0; i < std::size(methods); i++)
				trial.run(methods[i], shot.position, &scores[i]);
		}
	}
}

void print_row(const Condition &condition, const Method &method, const Score &score)
{
	const double n = std::max(score.centres, 1), points = std::max(score.points, 1);
	const double bias[2] = {score.sum[0] / n, score.sum[1] / n};
	const auto spread = [&](int axis) { return std::sqrt(score.sum2[axis] / n - bias[axis] * bias[axis]); };
	std::string name = condition.name;
	std::replace(name.begin(), name.end(), ' ', '_');
	printf("%-10s %-18s %5d %5d %7.3f %8.3f %7.3f %7.3f %6.3f %6.3f %7.2f %7.2f %7.1f\n", name.c_str(), method.name,
	       score.shots, score.points, 1e3 * score.error / points, 1e3 * score.error_most, bias[0], bias[1],
	       spread(0), spread(1), score.normalised2 / n, score.normalised3 / points,
	       score.us / (2 * std::max(score.shots, 1)));
}

} // namespace

int bench::accuracy(int argc, char **argv)
{
	Settings settings;
	pong::Options options("pongeye-bench accuracy",
			      "Locate rendered balls at the paper's 60 places by every method, at rest and moving.",
			      "  $ pongeye-bench accuracy --seeds 1 | head -3\n");
	options.integer("--seeds", "2", "pictures of each place", &settings.seeds, 1, 1000);
	options.integer("--first-seed", "1", "the first seed", &settings.first_seed, 0, 1000000);
	options.number("--velocity-error", "0.15", "of the velocity that moving balls are located with, per axis, m/s",
		       &settings.velocity_error, 0, 10);
	if (!options.parse(argc, argv))
		return 0;
	printf("# light method shots points mean_mm max_mm bias_u bias_v sd_u sd_v nees2 nees3 us\n");
	for (const Condition &condition : conditions) {
		if (pong::stop_requested())
			break;
		Score scores[std::size(methods)];
		measure(condition, settings, scores);
		for (size_t i = 0; i < std::size(methods); i++)
			print_row(condition, methods[i], scores[i]);
		fflush(stdout);
	}
	return 0;
}
