#include "calibrate_start.hpp"

#include <cmath>
#include <limits>

#include "calibrate_linear.hpp"
#include "error.hpp"

namespace pong
{

namespace
{

const double no_cost = std::numeric_limits<double>::infinity();

// What one camera saw of one board, in the board frame.
std::vector<Sighted> sighted(const Problem &problem, int board, int side)
{
	std::vector<Sighted> points;
	for (const Seen &seen : problem.seen)
		if (seen.board == board && seen.side == side)
			points.push_back(
				{problem.boards[static_cast<size_t>(board)].points[static_cast<size_t>(seen.point)],
				 seen.pixel});
	return points;
}

Matrix3 matrix_K(const CameraModel &camera)
{
	Matrix3 K;
	K << camera.lens[0], 0, camera.lens[2], 0, camera.lens[1], camera.lens[3], 0, 0, 1;
	return K;
}

// The paper's method on what one camera saw of placed boards; false where they lie in one plane, or what comes out is
// no camera that could be.
bool start_from_placed(const Problem &problem, int side, CameraModel &camera)
{
	std::vector<Sighted> points;
	for (size_t i = 0; i < problem.boards.size(); i++)
		if (problem.boards[i].placed)
			for (Sighted point : sighted(problem, static_cast<int>(i), side)) {
				point.place = problem.boards[i].placement * point.place;
				points.push_back(point);
			}
	try {
		pong_camera direct = {};
		store(direct_projection(points, PONG_NORMALISE_DEVIATION), direct.P);
		camera = CameraModel(direct);
	} catch (const Fault &) {
		return false;
	}
	const double width = problem.prior.width[side], height = problem.prior.height[side];
	const auto &lens = camera.lens;
	return std::abs(lens[0] / lens[1] - 1) < 0.2 && lens[0] > 0.2 * width && lens[0] < 20 * width && lens[2] > 0 &&
	       lens[2] < width && lens[3] > 0 && lens[3] < height;
}

// Focal length from boards anyhow, principal point in the middle; the camera frame is the table frame.
CameraModel start_from_homographies(const Problem &problem, int side)
{
	std::vector<Matrix3> homographies;
	Matrix3 H;
	for (size_t i = 0; i < problem.boards.size(); i++)
		if (board_homography(sighted(problem, static_cast<int>(i), side), H))
			homographies.push_back(H);
	const Vector2 middle((problem.prior.width[side] - 1) / 2, (problem.prior.height[side] - 1) / 2);
	const double focal = focal_length(homographies, middle);
	if (!(focal > 0))
		throw Fault{PONG_ERROR_VALUE,
			    sentence("the boards that the %s camera saw do not tell its focal length: "
				     "add some that are tilted",
				     side ? "right" : "left")};
	CameraModel camera;
	camera.lens.head<4>() << focal, focal, middle;
	return camera;
}

// The pose of a board in a camera's frame; false where the camera did not see enough of it.
bool pose_in_camera(const Problem &problem, int board, int side, Pose &pose)
{
	const CameraModel &camera = problem.camera[static_cast<size_t>(side)];
	std::vector<Sighted> points = sighted(problem, board, side);
	pong_camera lens = {};
	camera.store_in(lens);
	const Camera parts(lens);
	for (Sighted &point : points)
		point.pixel = parts.ideal_pixel(parts.undistort(point.pixel));
	Matrix3 H;
	if (!board_homography(points, H))
		return false;
	pose = board_pose(H, matrix_K(camera));
	return true;
}

// The median distance between seen and expected, of one board or (-1) of all.
double median_miss(const Problem &problem, int board)
{
	std::vector<double> misses;
	for (const Seen &seen : problem.seen)
		if (board < 0 || seen.board == board)
			misses.push_back(residual(problem, seen).norm());
	if (misses.empty())
		return no_cost;
	const auto middle = misses.begin() + static_cast<std::ptrdiff_t>(misses.size() / 2);
	std::nth_element(misses.begin(), middle, misses.end());
	return *middle;
}

void place_camera(CameraModel &camera, const Pose &camera_from_table)
{
	camera.R = camera_from_table.R;
	camera.centre = camera_from_table.inverse().t;
}

// The pose of the right camera relative to the left follows from every board that both saw; the one that fits all
// boards best is taken, so that one bad board does no harm.
void relate_cameras(Problem &problem)
{
	Problem best;
	double best_miss = no_cost;
	for (size_t i = 0; i < problem.boards.size(); i++) {
		Pose in_left, in_right;
		const int board = static_cast<int>(i);
		if (!pose_in_camera(problem, board, PONG_LEFT, in_left) ||
		    !pose_in_camera(problem, board, PONG_RIGHT, in_right))
			continue;
		Problem trial = problem;
		place_camera(trial.camera[PONG_RIGHT], in_right * in_left.inverse() * problem.camera[PONG_LEFT].pose());
		start_boards(trial);
		const double miss = median_miss(trial, -1);
		if (miss < best_miss) {
			best_miss = miss;
			best = trial;
		}
	}
	if (best_miss == no_cost)
		throw Fault{PONG_ERROR_VALUE, "no board was seen by both cameras: nothing joins them"};
	problem = best;
}

// Move everything so that the first placed board that was seen stands where it was placed.
void move_to_placement(Problem &problem)
{
	for (const Board &board : problem.boards) {
		if (!board.placed)
			continue;
		const Pose old_from_new = board.pose * board.placement.inverse();
		for (CameraModel &camera : problem.camera)
			place_camera(camera, camera.pose() * old_from_new);
		start_boards(problem);
		return;
	}
}

} // namespace

Matrix3 camera_from_own_table()
{
	return Vector3(-1, -1, 1).asDiagonal();
}

void start_boards(Problem &problem)
{
	for (size_t i = 0; i < problem.boards.size(); i++) {
		Board &board = problem.boards[i];
		double best_miss = no_cost;
		Pose best = board.placed ? board.placement : board.pose;
		for (int side = 0; side < 2; side++) {
			Pose in_camera;
			if (!pose_in_camera(problem, static_cast<int>(i), side, in_camera))
				continue;
			board.pose = problem.camera[static_cast<size_t>(side)].pose().inverse() * in_camera;
			const double miss = median_miss(problem, static_cast<int>(i));
			if (miss < best_miss) {
				best_miss = miss;
				best = board.pose;
			}
		}
		board.pose = best;
	}
}

void start(Problem &problem)
{
	if (start_from_placed(problem, PONG_LEFT, problem.camera[PONG_LEFT]) &&
	    start_from_placed(problem, PONG_RIGHT, problem.camera[PONG_RIGHT])) {
		start_boards(problem);
		return;
	}
	for (int side = 0; side < 2; side++)
		problem.camera[static_cast<size_t>(side)] = start_from_homographies(problem, side);
	problem.camera[PONG_LEFT].R = camera_from_own_table();
	relate_cameras(problem);
	move_to_placement(problem);
}

} // namespace pong
