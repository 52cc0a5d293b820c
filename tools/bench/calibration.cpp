// pongeye-bench calibration: the paper's Fig. 9, and what it does not show. Planes at z = 0.2, 0.4, 0.6, 0.8 m
// calibrate; corners at z = 1.7 m are projected and compared with where they truly are, and points all over the table
// are reconstructed. With pictures instead: every second pair calibrates, the others check.
#include <cmath>
#include <cstdio>
#include <functional>
#include <glob.h>

#include "../calibrate/pictures.hpp"
#include "boards.hpp"
#include "commands.hpp"
#include "opencv_calibration.hpp"
#include "options.hpp"
#include "program.hpp"

namespace bench
{

namespace
{

using pong::Recording;

struct Conditions {
	double noise, k1, placement, tilt; // px, -, m, rad
};

// A way to calibrate: false where it cannot.
struct Method {
	const char *name;
	bool boards; // whether it uses the boards held at will, or the planes only
	std::function<bool(const Recording &, PictureSize, pong_calibration &)> run;
};

bool ours(const Recording &recording, PictureSize size, pong_profile profile, pong_normalisation normalisation,
	  bool table, pong_calibration &calibration)
{
	pong_calibrate_settings settings;
	pong_calibrate_defaults(profile, &settings);
	settings.normalisation = normalisation;
	settings.frame_is_left_camera = !table;
	for (int side = 0; side < 2; side++) {
		settings.width[side] = size.width;
		settings.height[side] = size.height;
	}
	return pong_calibrate(recording.views.data(), static_cast<int>(recording.views.size()),
			      recording.corners.data(), static_cast<int>(recording.corners.size()), &settings,
			      &calibration, nullptr, nullptr, nullptr) == PONG_FOUND;
}

// OpenCV's ways tell no covariance of points.
void forget_covariance(pong_calibration &calibration)
{
	for (auto &row : calibration.covariance)
		std::fill(std::begin(row), std::end(row), NAN);
}

std::vector<Method> methods()
{
	const auto paper = [](pong_normalisation normalisation) {
		return [normalisation](const Recording &recording, PictureSize size, pong_calibration &calibration) {
			return ours(recording, size, PONG_PAPER, normalisation, true, calibration);
		};
	};
	const auto best = [](const Recording &recording, PictureSize size, pong_calibration &calibration) {
		return ours(recording, size, PONG_BEST, PONG_NORMALISE_DEVIATION, true, calibration);
	};
	const auto each = [](const Recording &recording, PictureSize size, pong_calibration &calibration) {
		forget_covariance(calibration);
		return calibrate_each(recording.views, recording.corners, size, calibration.camera);
	};
	const auto stereo = [](const Recording &recording, PictureSize size, pong_calibration &calibration) {
		forget_covariance(calibration);
		return calibrate_stereo(recording.views, recording.corners, size, calibration.camera);
	};
	return {{"paper-unnormalised", false, paper(PONG_NORMALISE_NONE)},
		{"paper-variance", false, paper(PONG_NORMALISE_VARIANCE)},
		{"paper-deviation", false, paper(PONG_NORMALISE_DEVIATION)},
		{"best-planes-only", false, best},
		{"best", true, best},
		{"cv-calibrateCamera", false, each},
		{"cv-stereoCalibrate", true, stereo}};
}

// Root mean square of where corners at z = 1.7 m are projected, against where they are seen.
double error_at(double z, const pong::TrueRig &truth, const pong_camera camera[2])
{
	double squares = 0;
	int count = 0;
	for (int i = -5; i <= 5; i++)
		for (int j = -4; j <= 4; j++)
			for (int side = 0; side < 2; side++) {
				const Eigen::Vector3d place(0.03 * i, 0.03 * j, z);
				Eigen::Vector2d seen;
				double uv[2];
				if (!truth.camera[side].see(place, seen) ||
				    pong_project(&camera[side], place.data(), uv) != PONG_FOUND)
					continue;
				squares += (seen - Eigen::Vector2d(uv[0], uv[1])).squaredNorm();
				count++;
			}
	return count ? std::sqrt(squares / count) : NAN;
}

void run_conditions(const Conditions &conditions, int boards, int seeds)
{
	const pong::TrueRig rig = pong::true_rig(conditions.k1);
	pong::Session session;
	session.noise = conditions.noise;
	session.placement = conditions.placement;
	session.tilt = conditions.tilt;
	for (const Method &method : methods()) {
		double pixels = 0, volume = 0, squares = 0, expected = 0;
		int done = 0;
		session.boards = method.boards ? boards : 0;
		for (int seed = 1; seed <= seeds && !pong::stop_requested(); seed++) {
			std::mt19937_64 random(static_cast<uint64_t>(seed));
			const Recording recording = pong::record(rig, session, random);
			pong_calibration calibration;
			if (!method.run(recording, {pong::true_width, pong::true_height}, calibration))
				continue;
			const pong::VolumeError off = pong::volume_error(rig, calibration.camera, pong::table_volume());
			if (!std::isfinite(off.mean))
				continue;
			pixels += error_at(1.7, rig, calibration.camera);
			volume += 1e3 * off.mean;
			squares += off.rms * off.rms;
			expected += std::pow(pong::expected_error(calibration, pong::table_volume()), 2);
			done++;
		}
		if (pong::stop_requested())
			return;
		printf("%.2f %.2f %.1f %.1f %s ", conditions.noise, conditions.k1, 1e3 * conditions.placement,
		       1e3 * conditions.tilt, method.name);
		if (done && std::isfinite(expected))
			printf("%.4f %.3f %.3f %.3f %d\n", pixels / done, volume / done,
			       1e3 * std::sqrt(squares / done), 1e3 * std::sqrt(expected / done), seeds - done);
		else if (done)
			printf("%.4f %.3f %.3f - %d\n", pixels / done, volume / done, 1e3 * std::sqrt(squares / done),
			       seeds - done);
		else
			printf("- - - - %d\n", seeds);
		fflush(stdout);
	}
}

void run_figure(int boards, int seeds)
{
	printf("# noise_px k1 placement_mm tilt_mrad method error_px error_mm rms_mm expected_rms_mm failed\n");
	const Conditions usual = {0.1, -0.15, 0.0002, 0.001};
	run_conditions({0.1, 0, 0, 0}, boards, seeds);
	for (const double noise : {0.05, 0.1, 0.2, 0.5})
		run_conditions({noise, usual.k1, usual.placement, usual.tilt}, boards, seeds);
	for (const double k1 : {0.0, -0.02, -0.05, -0.1, -0.2})
		run_conditions({usual.noise, k1, usual.placement, usual.tilt}, boards, seeds);
	for (const double placement : {0.0, 0.0005, 0.001})
		run_conditions({usual.noise, usual.k1, placement, 5 * placement}, boards, seeds);
}

// Every second pair, from the first or from the second on.
Recording half_of(const std::vector<calibrate::Pair> &pairs, const calibrate::BoardSize &board, size_t first)
{
	Recording recording;
	for (size_t i = first; i < pairs.size(); i += 2) {
		const auto &found = pairs[i].found;
		if (found[0].corners.empty() || found[1].corners.empty()) {
			fprintf(stderr, "%s: not used: %s%s\n", pairs[i].name.c_str(), found[0].why.c_str(),
				found[1].why.c_str());
			continue;
		}
		for (const pong_side side : {PONG_LEFT, PONG_RIGHT})
			for (int point = 0; point < board.columns * board.rows; point++) {
				const cv::Point2f &corner = found[side].corners[static_cast<size_t>(point)];
				recording.corners.push_back({static_cast<int>(recording.views.size()),
							     side,
							     point,
							     {board.square * (point % board.columns),
							      board.square * (point / board.columns), 0},
							     {corner.x, corner.y},
							     1});
			}
		recording.views.push_back({});
	}
	return recording;
}

void print_held_out(const char *method, const Recording &recording, const Recording &check, const pong_camera camera[2])
{
	double rms[2];
	pong_error error;
	const Recording *recordings[2] = {&recording, &check};
	for (int i = 0; i < 2; i++)
		if (pong_calibration_check(camera, recordings[i]->views.data(),
					   static_cast<int>(recordings[i]->views.size()), recordings[i]->corners.data(),
					   static_cast<int>(recordings[i]->corners.size()), &rms[i], nullptr, nullptr,
					   &error) < 0)
			throw pong::Failure(error.text);
	printf("%s %zu %.4f %zu %.4f\n", method, recording.views.size(), rms[0], check.views.size(), rms[1]);
}

std::vector<std::string> expand(const std::string &pattern)
{
	glob_t matches = {};
	glob(pattern.c_str(), 0, nullptr, &matches);
	std::vector<std::string> files(matches.gl_pathv, matches.gl_pathv + matches.gl_pathc);
	globfree(&matches);
	if (files.empty())
		throw pong::Failure(pattern + ": no such pictures");
	return files;
}

void run_pictures(const std::string &left, const std::string &right, const calibrate::BoardSize &board)
{
	auto pairs = calibrate::pair_files(expand(left), expand(right));
	calibrate::find_boards(board, pairs);
	const Recording recording = half_of(pairs, board, 0), check = half_of(pairs, board, 1);
	const PictureSize size = {pairs.front().picture[0].cols, pairs.front().picture[0].rows};
	printf("# method pairs rms_px held_out_pairs held_out_rms_px\n");
	pong_calibration calibration;
	if (ours(recording, size, PONG_BEST, PONG_NORMALISE_DEVIATION, false, calibration))
		print_held_out("best", recording, check, calibration.camera);
	if (calibrate_stereo(recording.views, recording.corners, size, calibration.camera))
		print_held_out("cv-stereoCalibrate", recording, check, calibration.camera);
}

// How far apart two rigs put what one of them sees: points over the table, m.
void compare_rigs(const std::string &truth_path, const std::string &rig_path)
{
	pong_rig truth, rig;
	pong_error error;
	if (pong_rig_load(truth_path.c_str(), &truth, &error) < 0 || pong_rig_load(rig_path.c_str(), &rig, &error) < 0)
		throw pong::Failure(error.text);
	double sum = 0, worst = 0;
	int count = 0;
	for (const Eigen::Vector3d &position : pong::table_volume()) {
		double uv[2][2], found[3];
		bool seen = true;
		for (int side = 0; side < 2; side++) {
			const pong_camera &camera = truth.camera[side];
			seen = seen && pong_project(&camera, position.data(), uv[side]) == PONG_FOUND &&
			       uv[side][0] >= 0 && uv[side][1] >= 0 && uv[side][0] < camera.width &&
			       uv[side][1] < camera.height;
		}
		if (!seen || pong_triangulate(rig.camera, uv[PONG_LEFT], uv[PONG_RIGHT], found) != PONG_FOUND)
			continue;
		const double off = 1e3 * (Eigen::Vector3d(found) - position).norm();
		sum += off;
		worst = std::max(worst, off);
		count++;
	}
	printf("# places mean_mm worst_mm\n%d %.3f %.3f\n", count, sum / count, worst);
}

const char example[] =
	"  $ pongeye-bench calibration --seeds 5\n"
	"  $ pongeye-bench calibration --left 'b/*-left.png' --right 'b/*-right.png' --board 9x6 --square 0.025";

} // namespace

int calibration(int argc, char **argv)
{
	int seeds = 10, boards = 20;
	std::string left, right, size, truth, rig;
	calibrate::BoardSize board = {};
	pong::Options options("pongeye-bench calibration",
			      "Compare calibrations on simulated corners (the paper's Fig. 9), or on pictures; failed: "
			      "sessions from\n"
			      "which no rig came that sees all of the volume.",
			      example);
	options.integer("--seeds", "N", "simulated sessions for each row (10)", &seeds, 1, 10000);
	options.integer("--boards", "N", "boards held at will besides the four planes (20)", &boards, 3, 1000);
	options.text("--left", "PATTERN", "pictures instead: of the left camera", &left);
	options.text("--right", "PATTERN", "and of the right camera", &right);
	options.text("--board", "COLSxROWS", "inner corners of the board in the pictures", &size);
	options.number("--square", "METRES", "side of its squares, m", &board.square, 0.001, 10);
	options.text("--truth", "RIG", "compare rigs instead: points that this rig.toml sees", &truth);
	options.text("--rig", "RIG", "are reconstructed by this one", &rig);
	if (!options.parse(argc, argv))
		return 0;
	if (truth.empty() != rig.empty())
		throw pong::UsageError("--truth and --rig belong together");
	if (!truth.empty()) {
		compare_rigs(truth, rig);
		return 0;
	}
	if (left.empty()) {
		run_figure(boards, seeds);
		return 0;
	}
	char end;
	if (sscanf(size.c_str(), "%dx%d%c", &board.columns, &board.rows, &end) != 2 || board.columns < 3 ||
	    board.rows < 3 || board.square <= 0)
		throw pong::UsageError("pictures need --board COLSxROWS and --square");
	run_pictures(left, right, board);
	return 0;
}

} // namespace bench
