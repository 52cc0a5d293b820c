// Along every side of the rough quadrangle, profiles across the white line are fitted by outside, line and inside,
// three levels behind a Gaussian blur; the line is as wide as 20 mm of a table look there (ITTF), so that one thinner
// than a pixel still has an outer edge. A parabola through a side's edge points bears the lens' distortion; neighbours
// meet in the corners.
#include "table_corners.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Dense>
#include <opencv2/imgproc.hpp>

#include "program.hpp"

namespace calibrate
{

namespace
{

const double length = 2.74, width = 1.525, line_width = 0.020; // m
const double blur = 0.8;                                       // of lens and pixel, standard deviation, px
const int samples = 64;                                        // along a side
const double reaches[] = {14, 6, 4, 4};                        // how far from the last guess is looked, by round, px
const double least_contrast = 12;                              // of the line to both sides, grey levels
const double worst_rms = 0.6;                                  // of a side's points about its parabola, px
const double least_inliers = 0.5;                              // of a side's samples in the picture
const char *const side_names[] = {"near end", "right side", "far end", "left side"};

using Points = std::vector<cv::Point2d>;

// A side of the table: origin + t along + (a + b t + c t^2) inward, t in pixels.
struct Side {
	cv::Point2d origin, along, inward;
	double reach; // t of its other end
	Eigen::Vector3d curve = Eigen::Vector3d::Zero();

	cv::Point2d at(double t) const
	{
		return origin + t * along + curve.dot(Eigen::Vector3d(1, t, t * t)) * inward;
	}
	// How far a point lies inside of the curve, px.
	double beyond(const cv::Point2d &point) const
	{
		const double t = along.dot(point - origin);
		return inward.dot(point - origin) - curve.dot(Eigen::Vector3d(1, t, t * t));
	}
};

Side side_between(const TableCorners &corners, size_t number)
{
	Side side;
	side.origin = corners[number];
	const cv::Point2d chord = corners[(number + 1) % 4] - side.origin;
	side.reach = cv::norm(chord);
	side.along = chord / side.reach;
	side.inward = {side.along.y, -side.along.x};
	return side;
}

// The table's plane as the picture has it.
cv::Matx33d homography_of(const TableCorners &corners)
{
	const std::vector<cv::Point2f> table = {
		{0, 0}, {float(width), 0}, {float(width), float(length)}, {0, float(length)}};
	std::vector<cv::Point2f> picture;
	for (const cv::Point2d &corner : corners)
		picture.emplace_back(corner);
	return cv::getPerspectiveTransform(table, picture);
}

cv::Point2d mapped(const cv::Matx33d &H, double across, double along)
{
	const cv::Vec3d p = H * cv::Vec3d(across, along, 1);
	return {p[0] / p[2], p[1] / p[2]};
}

// How wide the white line looks at a point of a side, px.
double line_width_at(const cv::Matx33d &H, const cv::Matx33d &back, const Side &side, size_t number, double t)
{
	const cv::Point2d point = side.at(t);
	const cv::Point2d place = mapped(back, point.x, point.y);
	const cv::Point2d inward[] = {{0, line_width}, {-line_width, 0}, {0, -line_width}, {line_width, 0}};
	const cv::Point2d inner = mapped(H, place.x + inward[number].x, place.y + inward[number].y);
	return side.inward.dot(inner - point);
}

double level_at(const cv::Mat &picture, const cv::Point2d &place)
{
	const int u = static_cast<int>(place.x), v = static_cast<int>(place.y);
	const double a = place.x - u, b = place.y - v;
	return (1 - b) * ((1 - a) * picture.at<uchar>(v, u) + a * picture.at<uchar>(v, u + 1)) +
	       b * ((1 - a) * picture.at<uchar>(v + 1, u) + a * picture.at<uchar>(v + 1, u + 1));
}

bool inside(const cv::Mat &picture, const cv::Point2d &place)
{
	return place.x >= 0 && place.y >= 0 && place.x < picture.cols - 1 && place.y < picture.rows - 1;
}

double step_at(double distance)
{
	return 0.5 * std::erfc(-distance / (blur * M_SQRT2));
}

// Grey levels across the line, at `places` inward of the guess, px.
struct Profile {
	std::vector<double> places, levels;
};

// Averaged over three pixels along the side. Empty where it leaves the picture.
Profile profile_at(const cv::Mat &picture, const Side &side, double t, double outward, double inward)
{
	Profile profile;
	const cv::Point2d middle = side.at(t);
	for (double place = -outward; place <= inward; place += 0.5) {
		double sum = 0;
		for (const double beside : {-1.0, 0.0, 1.0}) {
			const cv::Point2d at = middle + place * side.inward + beside * side.along;
			if (!inside(picture, at))
				return {};
			sum += level_at(picture, at);
		}
		profile.places.push_back(place);
		profile.levels.push_back(sum / 3);
	}
	return profile;
}

// The squares that outside, line and inside leave when the outer edge is at `edge`; infinite where that is no white
// line.
double misfit(const Profile &profile, double edge, double line)
{
	Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
	Eigen::Vector3d b = Eigen::Vector3d::Zero();
	double squares = 0;
	for (size_t i = 0; i < profile.places.size(); i++) {
		const double outer = step_at(profile.places[i] - edge),
			     inner = step_at(profile.places[i] - edge - line);
		const Eigen::Vector3d shares(1 - outer, outer - inner, inner);
		A += shares * shares.transpose();
		b += shares * profile.levels[i];
		squares += profile.levels[i] * profile.levels[i];
	}
	const Eigen::Vector3d levels = A.ldlt().solve(b);
	const bool is_line = levels[1] > levels[0] + least_contrast && levels[1] > levels[2] + least_contrast;
	return is_line ? squares - levels.dot(b) : INFINITY;
}

// The outer edge that fits best, inward of the guess, px. False where there is no white line.
bool find_edge(const Profile &profile, double line, double reach, double *edge)
{
	const double step = reach > 8 ? 0.5 : 0.25;
	double best = INFINITY;
	for (double place = -reach; place <= reach; place += step) {
		const double squares = misfit(profile, place, line);
		if (squares < best) {
			best = squares;
			*edge = place;
		}
	}
	if (!std::isfinite(best) || std::abs(*edge) > reach - step)
		return false;
	// The minimum of the parabola through the best and its neighbours.
	const double before = misfit(profile, *edge - step, line), after = misfit(profile, *edge + step, line);
	const double bend = before - 2 * best + after;
	if (std::isfinite(bend) && bend > 0)
		*edge += step * std::clamp((before - after) / (2 * bend), -1.0, 1.0);
	return true;
}

Eigen::Vector3d parabola_through(const Side &side, const Points &points)
{
	Eigen::MatrixXd A(points.size(), 3);
	Eigen::VectorXd b(points.size());
	for (size_t i = 0; i < points.size(); i++) {
		const double t = side.along.dot(points[i] - side.origin);
		A.row(static_cast<Eigen::Index>(i)) << 1, t, t * t;
		b[static_cast<Eigen::Index>(i)] = side.inward.dot(points[i] - side.origin);
	}
	return A.colPivHouseholderQr().solve(b);
}

// The parabola with the least median distance among those through three points drawn at random: half of the points may
// be false. Returns the points near it.
Points agreeing(const Points &points, Side side)
{
	std::mt19937 random(1);
	double best = INFINITY;
	Points kept;
	for (int attempt = 0; attempt < 200; attempt++) {
		Points three;
		std::sample(points.begin(), points.end(), std::back_inserter(three), 3, random);
		side.curve = parabola_through(side, three);
		std::vector<double> distances;
		for (const cv::Point2d &point : points)
			distances.push_back(std::abs(side.beyond(point)));
		const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
		std::nth_element(distances.begin(), middle, distances.end());
		if (*middle >= best)
			continue;
		best = *middle;
		kept.clear();
		for (const cv::Point2d &point : points)
			if (std::abs(side.beyond(point)) <= std::max(3.5 * best, 0.3))
				kept.push_back(point);
	}
	return kept;
}

struct FittedSide {
	Side side;
	Points points;
	double rms;
};

FittedSide fit_side(const cv::Mat &picture, const TableCorners &corners, Side side, size_t number, double reach)
{
	const cv::Matx33d H = homography_of(corners), back = H.inv();
	Points points;
	int tried = 0;
	for (int i = 0; i < samples; i++) {
		const double t = side.reach * (0.03 + 0.94 * i / (samples - 1));
		const double line = line_width_at(H, back, side, number, t);
		const Profile profile = profile_at(picture, side, t, reach + 4, reach + line + 4);
		if (profile.places.empty())
			continue;
		tried++;
		double edge = 0;
		if (find_edge(profile, line, reach, &edge))
			points.push_back(side.at(t) + edge * side.inward);
	}
	const Points kept = points.size() < 8 ? Points() : agreeing(points, side);
	if (tried < samples / 6 || static_cast<double>(kept.size()) < std::max(8.0, least_inliers * tried))
		throw pong::Failure(
			pong::format("the table's %s is not seen as a white line where it should be: %zu of %d "
				     "places along it agree",
				     side_names[number], kept.size(), tried));
	side.curve = parabola_through(side, kept);
	double squares = 0;
	for (const cv::Point2d &point : kept)
		squares += side.beyond(point) * side.beyond(point);
	return {side, kept, std::sqrt(squares / static_cast<double>(kept.size()))};
}

// Where two sides meet: Newton's steps from where their chords do.
cv::Point2d meeting(const Side &a, const Side &b, cv::Point2d point)
{
	for (int i = 0; i < 10; i++) {
		const auto gradient = [&](const Side &side) {
			const double t = side.along.dot(point - side.origin);
			return side.inward - (side.curve[1] + 2 * t * side.curve[2]) * side.along;
		};
		const cv::Point2d ga = gradient(a), gb = gradient(b);
		const double fa = a.beyond(point), fb = b.beyond(point), determinant = ga.cross(gb);
		point -= cv::Point2d(fa * gb.y - fb * ga.y, fb * ga.x - fa * gb.x) / determinant;
	}
	return point;
}

bool is_table_like(const TableCorners &corners)
{
	for (size_t i = 0; i < 4; i++) {
		const cv::Point2d along = corners[(i + 1) % 4] - corners[i];
		if (along.cross(corners[(i + 2) % 4] - corners[i]) >= 0 || cv::norm(along) < 20)
			return false;
	}
	return true;
}

} // namespace

TableSight refine_table(const cv::Mat &picture, const TableCorners &rough)
{
	if (!is_table_like(rough))
		throw pong::Failure(
			"the table's corners are not in this order: near left, near right, far right, far left");
	TableSight sight;
	sight.corners = rough;
	std::array<Points, 4> before; // of the round before: where the sides bend
	for (const double reach : reaches) {
		std::vector<FittedSide> sides;
		for (size_t i = 0; i < 4; i++) {
			Side side = side_between(sight.corners, i);
			if (!before[i].empty())
				side.curve = parabola_through(side, before[i]);
			sides.push_back(fit_side(picture, sight.corners, side, i, reach));
			before[i] = sides.back().points;
		}
		sight.edge.clear();
		for (size_t i = 0; i < 4; i++) {
			sight.corners[i] = meeting(sides[(i + 3) % 4].side, sides[i].side, sight.corners[i]);
			sight.rms[i] = sides[i].rms;
			sight.edge.insert(sight.edge.end(), sides[i].points.begin(), sides[i].points.end());
		}
		if (!is_table_like(sight.corners))
			throw pong::Failure("the white lines near the table's corners do not bound a table");
	}
	for (size_t i = 0; i < 4; i++)
		if (sight.rms[i] > worst_rms)
			throw pong::Failure(pong::format("the table's %s is no clean line: its points miss by %.1f px",
							 side_names[i], sight.rms[i]));
	for (cv::Point2d &corner : sight.corners)
		if (!inside(picture, corner))
			corner = {NAN, NAN};
	return sight;
}

} // namespace calibrate
