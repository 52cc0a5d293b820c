// The table found freely: white ridges become lines, and of all quadrangles of lines that are white all around the
// largest is taken. The net's tape and the middle line make smaller ones.
#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "program.hpp"
#include "table_corners.hpp"

namespace calibrate
{

namespace
{

const double least_support = 0.65; // of each side: the part that is white; the net hides some
const double least_area = 0.02;    // of the picture's
const size_t most_lines = 16;      // the longest ones
const double same_angle = 2 * M_PI / 180, same_place = 0.012; // rad; parts of the picture's width

struct Line {
	cv::Point2d middle, along; // along has length 1
	double length;
};

// What is brighter than its surroundings and thin.
cv::Mat ridges(const cv::Mat &picture)
{
	const int size = std::max(9, picture.cols / 30) | 1;
	cv::Mat hat, mask;
	cv::morphologyEx(picture, hat, cv::MORPH_TOPHAT, cv::getStructuringElement(cv::MORPH_RECT, {size, size}));
	cv::GaussianBlur(hat, hat, {3, 3}, 0);
	cv::threshold(hat, mask, 18, 255, cv::THRESH_BINARY);
	return mask;
}

double angle_between(const Line &a, const Line &b)
{
	return std::asin(std::min(1.0, std::abs(a.along.cross(b.along))));
}

// Pieces of the same line become one, the longest first.
std::vector<Line> lines_of(const cv::Mat &mask)
{
	std::vector<cv::Vec4i> pieces;
	cv::HoughLinesP(mask, pieces, 1, CV_PI / 720, 50, mask.cols / 12.0, mask.cols / 40.0);
	std::vector<Line> lines;
	for (const cv::Vec4i &piece : pieces) {
		const cv::Point2d a(piece[0], piece[1]), b(piece[2], piece[3]);
		lines.push_back({(a + b) / 2, (b - a) / cv::norm(b - a), cv::norm(b - a)});
	}
	std::sort(lines.begin(), lines.end(), [](const Line &a, const Line &b) { return a.length > b.length; });
	std::vector<Line> different;
	for (const Line &line : lines) {
		const bool is_new = std::none_of(different.begin(), different.end(), [&](const Line &other) {
			return angle_between(line, other) < same_angle &&
			       std::abs(other.along.cross(line.middle - other.middle)) < same_place * mask.cols;
		});
		if (is_new && different.size() < most_lines)
			different.push_back(line);
	}
	return different;
}

bool cross(const Line &a, const Line &b, cv::Point2d &point)
{
	const double sine = a.along.cross(b.along);
	if (std::abs(sine) < 0.02)
		return false;
	point = a.middle + (b.middle - a.middle).cross(b.along) / sine * a.along;
	return true;
}

// The part of a stretch that is white, of what is in the picture; NaN where too little is.
double whiteness(const cv::Mat &mask, const cv::Point2d &from, const cv::Point2d &to)
{
	int white = 0, seen = 0;
	const int steps = 100;
	for (int i = 0; i <= steps; i++) {
		const cv::Point place = from + (to - from) * (static_cast<double>(i) / steps);
		if (!cv::Rect(cv::Point(), mask.size()).contains(place))
			continue;
		seen++;
		white += mask.at<uchar>(place) != 0;
	}
	return seen < steps / 6 ? NAN : static_cast<double>(white) / seen;
}

// White all along, and up to both corners: a line that ends before does not belong there.
bool is_side(const cv::Mat &mask, const cv::Point2d &from, const cv::Point2d &to)
{
	const cv::Point2d end = 0.12 * (to - from);
	const double whole = whiteness(mask, from, to);
	const double ends[] = {whiteness(mask, from, from + end), whiteness(mask, to - end, to)};
	return whole >= least_support && !(ends[0] < least_support) && !(ends[1] < least_support);
}

// Near left, near right, far right, far left; false where the four lines do not lie as a table's.
bool corners_of(const Line *const (&lines)[4], TableCorners &corners)
{
	for (size_t i = 0; i < 4; i++)
		if (!cross(*lines[(i + 3) % 4], *lines[i], corners[i]))
			return false;
	for (size_t i = 0; i < 4; i++)
		if ((corners[(i + 1) % 4] - corners[i]).cross(corners[(i + 2) % 4] - corners[i]) >= 0)
			return false;
	// Seen from behind one end the near end looks longer.
	return corners[0].y > corners[3].y && corners[1].y > corners[2].y &&
	       cv::norm(corners[1] - corners[0]) > cv::norm(corners[3] - corners[2]);
}

double area_of(const TableCorners &corners)
{
	return std::abs((corners[2] - corners[0]).cross(corners[3] - corners[1])) / 2;
}

bool is_white_all_around(const cv::Mat &mask, const TableCorners &corners)
{
	for (size_t i = 0; i < 4; i++)
		if (!is_side(mask, corners[i], corners[(i + 1) % 4]))
			return false;
	return true;
}

} // namespace

TableCorners find_table(const cv::Mat &picture)
{
	const cv::Mat mask = ridges(picture);
	cv::Mat wide;
	cv::dilate(mask, wide, cv::getStructuringElement(cv::MORPH_RECT, {9, 9})); // lenses bend lines
	const std::vector<Line> lines = lines_of(mask);
	TableCorners best = {}, corners;
	double best_area = least_area * static_cast<double>(picture.total());
	for (const Line &near : lines)
		for (const Line &right : lines)
			for (const Line &far : lines)
				for (const Line &left : lines) {
					const Line *const sides[4] = {&near, &right, &far, &left};
					if (!corners_of(sides, corners) || area_of(corners) <= best_area ||
					    !is_white_all_around(wide, corners))
						continue;
					best_area = area_of(corners);
					best = corners;
				}
	if (best[0] == best[2])
		throw pong::Failure("no table is found in the picture: no quadrangle of white lines");
	return best;
}

} // namespace calibrate
