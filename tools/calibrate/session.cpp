#include "session.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "program.hpp"
#include "table_view.hpp"

namespace calibrate
{

namespace
{

// A picture whose corners miss by so many times what is usual spoils the rest.
const double usual_factor = 3;

struct Placement {
	double R[3][3];
	double t[3];
	const double *sigma; // m, rad
};

pong_view placed(const Placement &placement)
{
	pong_view view = {};
	view.placed = 1;
	for (int i = 0; i < 3; i++) {
		std::copy_n(placement.R[i], 3, view.pose[i]);
		view.pose[i][3] = placement.t[i];
	}
	view.sigma_position = placement.sigma[0];
	view.sigma_angle = placement.sigma[1];
	return view;
}

// The board frame stands in the board's middle: x along the rows, y down the columns, z into the board. Upright before
// the cameras x runs to the robot's right and y down; lying on the table y runs towards the robot.
pong_view view_of(const Arguments &arguments, const Pair &pair, size_t number)
{
	if (number < arguments.plane_z.size())
		return placed({{{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}},
			       {arguments.plane_at[0], arguments.plane_at[1], arguments.plane_z[number]},
			       arguments.plane_sigma});
	if (!arguments.flat.empty() && pair.name == arguments.flat)
		return placed({{{-1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
			       {arguments.flat_at[0], arguments.flat_at[2], arguments.flat_at[1]},
			       arguments.flat_sigma});
	return {};
}

void add_corners(const BoardSize &board, const Pair &pair, int view, std::vector<pong_corner> &corners)
{
	for (const pong_side side : {PONG_LEFT, PONG_RIGHT}) {
		const auto &found = pair.found[side].corners;
		for (size_t i = 0; i < found.size(); i++) {
			const int point = static_cast<int>(i), column = point % board.columns,
				  row = point / board.columns;
			corners.push_back({view,
					   side,
					   point,
					   {(column - (board.columns - 1) / 2.0) * board.square,
					    (row - (board.rows - 1) / 2.0) * board.square, 0},
					   {found[i].x, found[i].y},
					   1});
		}
	}
}

pong_calibrate_settings settings_for(const Arguments &arguments, const Session &session)
{
	pong_calibrate_settings settings;
	pong_calibrate_defaults(static_cast<pong_profile>(arguments.profile), &settings);
	for (const Pair &pair : session.pairs)
		for (size_t side = 0; side < 2; side++)
			if (!pair.picture[side].empty()) {
				settings.width[side] = pair.picture[side].cols;
				settings.height[side] = pair.picture[side].rows;
			}
	settings.frame_is_left_camera = arguments.no_table;
	return settings;
}

// The pair that --flat names, by its pictures' name.
void check_flat(const std::string &flat, const std::vector<Pair> &pairs)
{
	const auto named = [&](const Pair &pair) { return pair.name == flat; };
	if (!flat.empty() && !pairs.empty() && std::none_of(pairs.begin(), pairs.end(), named))
		throw pong::Failure(pong::format("--flat %s: no pair has this name; the first is %s, the last %s",
						 flat.c_str(), pairs.front().name.c_str(), pairs.back().name.c_str()));
}

void calibrate_once(const Arguments &arguments, Session &session)
{
	check_flat(arguments.flat, session.pairs);
	build_views(arguments, session);
	if (session.used.empty())
		throw pong::Failure(session.pairs.empty()
					    ? "there are no pictures"
					    : pong::format("no board of %d x %d inner corners in any picture; %s: %s",
							   arguments.board.columns, arguments.board.rows,
							   session.pairs.front().name.c_str(),
							   session.pairs.front().rejected.c_str()));
	const pong_calibrate_settings settings = settings_for(arguments, session);
	session.results.resize(session.views.size());
	session.residuals.resize(session.corners.size());
	pong_error error;
	if (pong_calibrate(session.views.data(), static_cast<int>(session.views.size()), session.corners.data(),
			   static_cast<int>(session.corners.size()), &settings, &session.calibration,
			   session.results.data(), reinterpret_cast<double(*)[2]>(session.residuals.data()),
			   &error) < 0)
		throw pong::Failure(error.text);
}

double worst_of(const pong_view_result &result)
{
	return std::max(result.rms[0], result.rms[1]);
}

// Name the view that fits the others least, if it is far worse than they are. One at a time: a bad one makes others
// look bad.
bool reject_worst(Session &session)
{
	std::vector<double> misses;
	for (size_t i = 0; i < session.used.size(); i++)
		misses.push_back(worst_of(session.results[i]));
	const auto worst = std::max_element(misses.begin(), misses.end());
	std::vector<double> sorted = misses;
	std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2), sorted.end());
	const double usual = sorted[sorted.size() / 2];
	if (misses.size() < 4 || *worst < usual_factor * std::max(usual, 0.05))
		return false;
	session.pairs[session.used[static_cast<size_t>(worst - misses.begin())]].rejected =
		pong::format("does not fit the others: its corners miss by %.2f px, theirs by %.2f: moved or misread",
			     *worst, usual);
	return true;
}

// Placed boards that stand elsewhere than was said.
void check_placement(const Arguments &arguments, Session &session)
{
	for (size_t i = 0; i < session.used.size(); i++) {
		const pong_view &view = session.views[i];
		if (!view.placed || arguments.profile == PONG_PAPER)
			continue;
		double squares = 0;
		for (int axis = 0; axis < 3; axis++)
			squares += std::pow(session.results[i].pose[axis][3] - view.pose[axis][3], 2);
		if (std::sqrt(squares) > 5 * view.sigma_position)
			session.notes.push_back(pong::format("%s stood %.1f mm from where it was said to stand",
							     session.pairs[session.used[i]].name.c_str(),
							     1e3 * std::sqrt(squares)));
	}
}

} // namespace

void build_views(const Arguments &arguments, Session &session)
{
	session.used.clear();
	session.views.clear();
	session.corners.clear();
	for (size_t i = 0; i < session.pairs.size(); i++) {
		const Pair &pair = session.pairs[i];
		if (!pair.rejected.empty())
			continue;
		add_corners(arguments.board, pair, static_cast<int>(session.views.size()), session.corners);
		session.views.push_back(view_of(arguments, pair, i));
		session.used.push_back(i);
	}
	if (!session.used.empty() && session.table.given)
		add_table(arguments, session);
}

void solve(const Arguments &arguments, Session &session)
{
	calibrate_once(arguments, session);
	while (arguments.profile == PONG_BEST && reject_worst(session))
		calibrate_once(arguments, session);
	check_placement(arguments, session);
	check_table(arguments, session);
}

double score(const pong_camera camera[2], Session &session)
{
	session.results.resize(session.views.size());
	session.residuals.resize(session.corners.size());
	double rms;
	pong_error error;
	if (pong_calibration_check(camera, session.views.data(), static_cast<int>(session.views.size()),
				   session.corners.data(), static_cast<int>(session.corners.size()), &rms,
				   session.results.data(), reinterpret_cast<double(*)[2]>(session.residuals.data()),
				   &error) < 0)
		throw pong::Failure(error.text);
	return rms;
}

// The size of a board that fits the reconstructed corners best: distances between noisy points would come out too long.
double measured_square(const pong_camera camera[2], const BoardSize &board, const Session &session)
{
	double sum = 0;
	int count = 0;
	for (const size_t number : session.used) {
		const auto &left = session.pairs[number].found[PONG_LEFT].corners;
		const auto &right = session.pairs[number].found[PONG_RIGHT].corners;
		const auto corners = static_cast<Eigen::Index>(std::min(left.size(), right.size()));
		Eigen::Matrix3Xd model(3, corners), measured(3, corners);
		bool all = corners > 0;
		for (Eigen::Index i = 0; i < corners; i++) {
			const cv::Point2f &a = left[static_cast<size_t>(i)], &b = right[static_cast<size_t>(i)];
			const double left_uv[2] = {a.x, a.y}, right_uv[2] = {b.x, b.y};
			Eigen::Vector3d place;
			all = all && pong_triangulate(camera, left_uv, right_uv, place.data()) == PONG_FOUND;
			model.col(i) << static_cast<double>(i % board.columns), static_cast<double>(i / board.columns),
				0;
			measured.col(i) = place;
		}
		if (!all)
			continue;
		sum += Eigen::umeyama(model, measured).topLeftCorner<3, 3>().col(0).norm();
		count++;
	}
	return count ? sum / count : NAN;
}

} // namespace calibrate
