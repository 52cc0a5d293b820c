// Calibration, as the header has it: what comes in is checked, solved and written out.
#include <algorithm>
#include <cmath>
#include <limits>

#include "calibrate_linear.hpp"
#include "calibrate_solve.hpp"
#include "calibrate_start.hpp"
#include "error.hpp"
#include "pongeye.h"

namespace pong
{

namespace
{

// What the caller gave.
struct Views {
	const pong_view *views;
	int view_count;
	const pong_corner *corners;
	int corner_count;
};

// What the caller wants to know besides; may be NULL.
struct Wanted {
	pong_view_result *results;
	double (*residuals)[2];
};

Board board_of(const pong_view &view)
{
	Board board;
	board.placed = view.placed != 0;
	if (board.placed)
		board.placement = pose_of(view.pose);
	board.sigma_position = view.sigma_position;
	board.sigma_angle = view.sigma_angle;
	board.sigma_shape = view.sigma_shape;
	return board;
}

void check_corner(const Views &given, int number)
{
	const pong_corner &corner = given.corners[number];
	if (corner.view < 0 || corner.view >= given.view_count)
		throw Fault{PONG_ERROR_VALUE, sentence("corner %d is of view %d, but there are %d", number, corner.view,
						       given.view_count)};
	if (corner.side != PONG_LEFT && corner.side != PONG_RIGHT)
		throw Fault{PONG_ERROR_VALUE, sentence("corner %d is of neither camera", number)};
	if (corner.point < 0 || corner.point >= 100000)
		throw Fault{PONG_ERROR_VALUE, sentence("corner %d has point number %d", number, corner.point)};
	for (const double value : {corner.uv[0], corner.uv[1], corner.board[0], corner.board[1], corner.board[2]})
		if (!std::isfinite(value))
			throw Fault{PONG_ERROR_VALUE, sentence("corner %d is not finite", number)};
}

Problem problem_of(const Views &given)
{
	Problem problem;
	for (int i = 0; i < given.view_count; i++)
		problem.boards.push_back(board_of(given.views[i]));
	for (int i = 0; i < given.corner_count; i++) {
		check_corner(given, i);
		const pong_corner &corner = given.corners[i];
		auto &points = problem.boards[static_cast<size_t>(corner.view)].points;
		points.resize(std::max(points.size(), static_cast<size_t>(corner.point) + 1), Vector3::Zero());
		points[static_cast<size_t>(corner.point)] = vector_of(corner.board);
		problem.seen.push_back({corner.view,
					corner.side,
					corner.point,
					{corner.uv[0], corner.uv[1]},
					corner.spread > 0 ? corner.spread : 1});
	}
	for (Board &board : problem.boards)
		if (board.sigma_shape > 0 && board.points.size() > 2) {
			board.bend = deformations(board.points);
			board.shape.setZero(board.bend.cols());
		}
	return problem;
}

// Only what both cameras share tells how they stand to each other; a board nobody saw tells nothing at all.
void check_views(const Problem &problem, bool frame_is_left_camera)
{
	std::vector<int> corners(problem.boards.size());
	for (const Seen &seen : problem.seen)
		corners[static_cast<size_t>(seen.board)]++;
	for (size_t i = 0; i < corners.size(); i++)
		if (corners[i] < 4)
			throw Fault{PONG_ERROR_VALUE, sentence("view %zu has %d corners, needs 4", i, corners[i])};
	const bool placed = std::any_of(problem.boards.begin(), problem.boards.end(),
					[](const Board &board) { return board.placed; });
	if (!placed && !frame_is_left_camera)
		throw Fault{PONG_ERROR_VALUE, "no view is placed: nothing says where the table frame is"};
}

void set_prior(Problem &problem, const pong_calibrate_settings &settings)
{
	problem.loss = settings.loss;
	problem.prior.aspect = settings.aspect;
	problem.prior.principal = settings.principal;
	std::copy_n(settings.distortion, 5, problem.prior.distortion);
	for (int side = 0; side < 2; side++) {
		problem.prior.width[side] = settings.width[side];
		problem.prior.height[side] = settings.height[side];
		for (int i = 0; i < 5; i++)
			problem.held[static_cast<size_t>(side * camera_numbers + 4 + i)] = settings.distortion[i] == 0;
	}
	for (size_t number = 9; settings.frame_is_left_camera && number < camera_numbers; number++)
		problem.held[number] = true;
}

pong_camera empty_camera(const pong_calibrate_settings &settings, int side)
{
	pong_camera camera = {};
	camera.width = settings.width[side];
	camera.height = settings.height[side];
	return camera;
}

double rms_of(const Problem &problem)
{
	double squares = 0;
	for (const Seen &seen : problem.seen)
		squares += residual(problem, seen).squaredNorm();
	return std::sqrt(squares / static_cast<double>(problem.seen.size()));
}

void report(const Problem &problem, const Wanted &wanted)
{
	std::vector<pong_view_result> results(problem.boards.size());
	for (size_t i = 0; i < results.size(); i++) {
		store(problem.boards[i].pose, results[i].pose);
		Eigen::Map<Eigen::Matrix<double, 6, 6>>{&results[i].covariance[0][0]}.setConstant(
			std::numeric_limits<double>::quiet_NaN());
	}
	for (size_t i = 0; i < problem.seen.size(); i++) {
		const Seen &seen = problem.seen[i];
		const Vector2 miss = residual(problem, seen);
		pong_view_result &result = results[static_cast<size_t>(seen.board)];
		result.corners[seen.side]++;
		result.rms[seen.side] += miss.squaredNorm();
		if (wanted.residuals)
			std::copy_n(miss.data(), 2, wanted.residuals[i]);
	}
	for (pong_view_result &result : results)
		for (int side = 0; side < 2; side++)
			result.rms[side] = std::sqrt(result.rms[side] / std::max(result.corners[side], 1));
	if (wanted.results)
		std::copy(results.begin(), results.end(), wanted.results);
}

void report_covariances(const Problem &problem, const RigMatrix &rig, pong_view_result *results)
{
	if (!results)
		return;
	const auto covariances = board_covariances(problem, rig);
	for (size_t i = 0; i < covariances.size(); i++)
		Eigen::Map<Eigen::Matrix<double, 6, 6>>{&results[i].covariance[0][0]} = covariances[i];
}

// The paper's method: P as the linear system gives it, of corners that stand where their boards were placed.
void calibrate_directly(Problem &problem, const pong_calibrate_settings &settings, pong_calibration &calibration,
			const Wanted &wanted)
{
	double squares = 0;
	std::vector<Vector2> misses(problem.seen.size());
	for (int side = 0; side < 2; side++) {
		std::vector<Sighted> points;
		std::vector<size_t> numbers;
		for (size_t i = 0; i < problem.seen.size(); i++) {
			const Seen &seen = problem.seen[i];
			Board &board = problem.boards[static_cast<size_t>(seen.board)];
			board.pose = board.placement;
			if (seen.side != side || !board.placed)
				continue;
			points.push_back({board.placement * board.point(seen.point), seen.pixel});
			numbers.push_back(i);
		}
		const Matrix34 P = direct_projection(points, settings.normalisation);
		store(P, calibration.camera[side].P);
		for (size_t i = 0; i < points.size(); i++) {
			misses[numbers[i]] = points[i].pixel - (P * points[i].place.homogeneous()).hnormalized();
			squares += misses[numbers[i]].squaredNorm();
		}
		problem.camera[static_cast<size_t>(side)] = CameraModel(calibration.camera[side]);
	}
	report(problem, wanted);
	for (size_t i = 0; wanted.residuals && i < misses.size(); i++)
		std::copy_n(misses[i].data(), 2, wanted.residuals[i]);
	const double count = static_cast<double>(problem.seen.size());
	calibration.rms = std::sqrt(squares / count);
	calibration.sigma = std::sqrt(squares / std::max(2 * count - 22, 1.0));
	Eigen::Map<RigMatrix>{&calibration.covariance[0][0]}.setConstant(std::numeric_limits<double>::quiet_NaN());
}

void calibrate_jointly(Problem &problem, pong_calibration &calibration, const Wanted &wanted)
{
	start(problem);
	solve(problem);
	const RigMatrix covariance = rig_covariance(problem);
	for (size_t side = 0; side < 2; side++)
		problem.camera[side].store_in(calibration.camera[side]);
	Eigen::Map<RigMatrix>{&calibration.covariance[0][0]} = covariance;
	calibration.sigma = problem.sigma;
	calibration.rms = rms_of(problem);
	report(problem, wanted);
	report_covariances(problem, covariance, wanted.results);
}

pong_calibration calibrate(const Views &given, const pong_calibrate_settings &settings, const Wanted &wanted)
{
	pong_calibration calibration = {};
	for (int side = 0; side < 2; side++) {
		if (settings.width[side] < 16 || settings.height[side] < 16)
			throw Fault{PONG_ERROR_VALUE, "the pictures' size is missing from the settings"};
		calibration.camera[side] = empty_camera(settings, side);
	}
	Problem problem = problem_of(given);
	check_views(problem, settings.frame_is_left_camera != 0);
	set_prior(problem, settings);
	if (settings.profile == PONG_PAPER)
		calibrate_directly(problem, settings, calibration, wanted);
	else
		calibrate_jointly(problem, calibration, wanted);
	return calibration;
}

double check(const pong_camera camera[2], const Views &given, const Wanted &wanted)
{
	Problem problem = problem_of(given);
	check_views(problem, true);
	problem.held.fill(true);
	for (Board &board : problem.boards)
		board.placed = false;
	for (size_t side = 0; side < 2; side++)
		problem.camera[side] = CameraModel(camera[side]);
	start_boards(problem);
	solve(problem);
	report(problem, wanted);
	return rms_of(problem);
}

} // namespace

} // namespace pong

void pong_calibrate_defaults(pong_profile profile, pong_calibrate_settings *settings)
{
	*settings = {};
	settings->profile = profile;
	// With a real lens the variance does a tenth better, with a perfect one a tenth worse (docs/calibrate.md).
	settings->normalisation = profile == PONG_PAPER ? PONG_NORMALISE_VARIANCE : PONG_NORMALISE_DEVIATION;
	settings->aspect = 0.005;
	settings->principal = 0.1;
	const double distortion[5] = {0.5, 1, 0.005, 0.005, 0};
	std::copy_n(distortion, 5, settings->distortion);
	settings->loss = 3;
}

int pong_calibrate(const pong_view *views, int view_count, const pong_corner *corners, int corner_count,
		   const pong_calibrate_settings *settings, pong_calibration *calibration, pong_view_result *results,
		   double (*residuals)[2], pong_error *error)
{
	return pong::guarded(error, [&] {
		*calibration =
			pong::calibrate({views, view_count, corners, corner_count}, *settings, {results, residuals});
		return PONG_FOUND;
	});
}

int pong_calibration_check(const pong_camera camera[2], const pong_view *views, int view_count,
			   const pong_corner *corners, int corner_count, double *rms, pong_view_result *results,
			   double (*residuals)[2], pong_error *error)
{
	return pong::guarded(error, [&] {
		*rms = pong::check(camera, {views, view_count, corners, corner_count}, {results, residuals});
		return PONG_FOUND;
	});
}
