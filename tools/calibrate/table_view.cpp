#include "table_view.hpp"

#include <algorithm>
#include <cmath>

#include "program.hpp"

namespace calibrate
{

namespace
{

const double length = 2.74, width = 1.525; // m
// The corners in the table's own board frame, which lies as a board on the table does, rows across it: x to the robot's
// right, y towards it, z into the table.
const double place[4][3] = {{-width / 2, 0, 0}, {width / 2, 0, 0}, {width / 2, -length, 0}, {-width / 2, -length, 0}};
const double pose[3][3] = {{-1, 0, 0}, {0, 0, -1}, {0, -1, 0}};
const double given_spread = 5, found_spread = 2; // the noise of the table's corners over that of a board's
const double worst_fit = 2;                      // of found corners to a table of the stated size, rms, px
const char *const side_names[] = {"left", "right"};

TableCorners corners_of(const std::vector<double> &numbers)
{
	TableCorners corners;
	for (size_t i = 0; i < 4; i++)
		corners[i] = {numbers[2 * i], numbers[2 * i + 1]};
	return corners;
}

// As --table-left takes them.
std::string numbers_of(const TableCorners &corners)
{
	std::string text;
	for (const cv::Point2d &corner : corners)
		text += pong::format("%s%.2f,%.2f", text.empty() ? "" : ",", corner.x, corner.y);
	return text;
}

bool is_seen(const cv::Point2d &corner)
{
	return std::isfinite(corner.x) && std::isfinite(corner.y);
}

// Take the pair of this name; where it shows no board, it is no longer one of the pairs.
Pair take_pair(const std::string &name, std::vector<Pair> &pairs)
{
	const auto found =
		std::find_if(pairs.begin(), pairs.end(), [&](const Pair &pair) { return pair.name == name; });
	if (found == pairs.end())
		throw pong::Failure("--table " + name + ": there is no such pair of pictures");
	Pair pair = *found;
	if (pair.picture[0].empty() || pair.picture[1].empty())
		throw pong::Failure("--table " + name + ": needs a picture of both cameras");
	if (!pair.rejected.empty())
		pairs.erase(found);
	return pair;
}

TableSight sight_of(const cv::Mat &picture, const std::vector<double> &rough, const std::string &name)
{
	try {
		if (std::any_of(rough.begin(), rough.end(), [](double number) { return !std::isfinite(number); }))
			throw pong::Failure(
				"all four corners are needed roughly; one beyond the border is given where it "
				"would be");
		return refine_table(picture, rough.empty() ? find_table(picture) : corners_of(rough));
	} catch (const pong::Failure &failure) {
		throw pong::Failure(name + ": " + failure.what());
	}
}

pong_view table_view(double sigma_shape)
{
	pong_view view = {};
	view.placed = 1;
	for (int i = 0; i < 3; i++)
		std::copy_n(pose[i], 3, view.pose[i]);
	view.sigma_shape = sigma_shape;
	return view;
}

void add_corners(const TableView &table, int view, std::vector<pong_corner> &corners)
{
	const double spread = table.name.empty() ? given_spread : found_spread;
	for (const pong_side side : {PONG_LEFT, PONG_RIGHT})
		for (int point = 0; point < 4; point++) {
			const cv::Point2d &corner = table.corners[side][static_cast<size_t>(point)];
			const double *p = place[point];
			if (is_seen(corner))
				corners.push_back(
					{view, side, point, {p[0], p[1], p[2]}, {corner.x, corner.y}, spread});
		}
}

// How far the corners miss those of a table that has exactly its size and stands where it fits best, rms, px.
double fit_of(const Session &session)
{
	std::vector<pong_corner> corners;
	add_corners(session.table, 0, corners);
	const pong_view view = table_view(0);
	double rms;
	pong_error error;
	if (pong_calibration_check(session.calibration.camera, &view, 1, corners.data(),
				   static_cast<int>(corners.size()), &rms, nullptr, nullptr, &error) < 0)
		throw pong::Failure(std::string("the table: ") + error.text);
	return rms;
}

void note_sides(Session &session)
{
	double at[4][3];
	for (size_t point = 0; point < 4; point++) {
		const cv::Point2d &left = session.table.corners[PONG_LEFT][point],
				  &right = session.table.corners[PONG_RIGHT][point];
		const double left_uv[2] = {left.x, left.y}, right_uv[2] = {right.x, right.y};
		if (!is_seen(left) || !is_seen(right) ||
		    pong_triangulate(session.calibration.camera, left_uv, right_uv, at[point]) != PONG_FOUND)
			std::fill_n(at[point], 3, NAN);
	}
	const struct {
		const char *name;
		int from, to;
		double stated;
	} sides[] = {{"near end", 0, 1, width},
		     {"far end", 2, 3, width},
		     {"left side", 0, 3, length},
		     {"right side", 1, 2, length}};
	for (const auto &side : sides) {
		const double *a = at[side.from], *b = at[side.to];
		const double measured = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
		if (std::isfinite(measured))
			session.notes.push_back(pong::format("the table's %s measures %.1f mm, should %.1f", side.name,
							     1e3 * measured, 1e3 * side.stated));
	}
}

} // namespace

void locate_table(const Arguments &arguments, Session &session)
{
	TableView &table = session.table;
	table.given = !arguments.table[0].empty() || !arguments.table_pair.empty();
	if (!table.given)
		return;
	if (arguments.table_pair.empty()) {
		for (size_t side = 0; side < 2; side++)
			table.corners[side] = corners_of(arguments.table[side]);
		return;
	}
	const Pair pair = take_pair(arguments.table_pair, session.pairs);
	table.name = pair.name;
	for (size_t side = 0; side < 2; side++) {
		const TableSight sight = sight_of(pair.picture[side], arguments.table[side],
						  pair.name + ", " + side_names[side] + " picture");
		table.picture[side] = pair.picture[side];
		table.corners[side] = sight.corners;
		table.edge[side] = sight.edge;
		if (!std::all_of(sight.corners.begin(), sight.corners.end(), is_seen))
			throw pong::Failure(pair.name + ", " + side_names[side] +
					    " picture: not all of the table's corners are in it; let --flat or "
					    "--plane-z say where the table is");
		session.notes.push_back(
			pong::format("--table-%s %s", side_names[side], numbers_of(sight.corners).c_str()));
	}
}

void add_table(const Arguments &arguments, Session &session)
{
	add_corners(session.table, static_cast<int>(session.views.size()), session.corners);
	session.views.push_back(table_view(arguments.table_sigma > 0 ? arguments.table_sigma : 1));
}

void check_table(const Arguments &arguments, Session &session)
{
	if (!session.table.given || session.corners.empty())
		return;
	const double fit = fit_of(session);
	session.notes.push_back(pong::format("the table's corners fit its size to %.2f px rms", fit));
	note_sides(session);
	if (!session.table.name.empty() && fit > worst_fit && !arguments.force)
		throw pong::Failure(
			pong::format("%s: the corners that were found miss a table of %.2f x %.3f m by %.1f px "
				     "rms: give them by --table-left and --table-right",
				     session.table.name.c_str(), length, width, fit));
}

} // namespace calibrate
