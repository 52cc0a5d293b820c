#include "corners.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "program.hpp"

namespace calibrate
{

namespace
{

using Corners = std::vector<cv::Point2f>;

// Edges wider than this part of a square are blurred: the corner's place hangs on how the board moved.
const double blur_limit = 0.25;

cv::Point2f along_rows(const Corners &corners, const BoardSize &board)
{
	cv::Point2f sum;
	for (int row = 0; row < board.rows; row++)
		sum += corners[static_cast<size_t>((row + 1) * board.columns - 1)] -
		       corners[static_cast<size_t>(row * board.columns)];
	return sum;
}

cv::Point2f along_columns(const Corners &corners, const BoardSize &board)
{
	cv::Point2f sum;
	for (int column = 0; column < board.columns; column++)
		sum += corners[static_cast<size_t>((board.rows - 1) * board.columns + column)] -
		       corners[static_cast<size_t>(column)];
	return sum;
}

// The board seen from its front: rows to the right, columns down. OpenCV's finders may begin at any corner.
void make_upright(const BoardSize &board, Corners &corners)
{
	const cv::Point2f across = along_rows(corners, board), down = along_columns(corners, board);
	if (across.cross(down) < 0)
		for (int row = 0; row < board.rows; row++)
			std::reverse(corners.begin() + row * board.columns,
				     corners.begin() + (row + 1) * board.columns);
	const cv::Point2f now = along_rows(corners, board);
	const bool lies = std::abs(now.x) < std::abs(now.y);
	if (lies ? along_columns(corners, board).x < 0 : now.x < 0)
		std::reverse(corners.begin(), corners.end());
}

// The least distance between neighbours, px.
double least_step(const Corners &corners, const BoardSize &board)
{
	double least = 1e9;
	for (int i = 0; i < board.rows * board.columns; i++) {
		const auto at = static_cast<size_t>(i);
		if (i % board.columns)
			least = std::min(least, cv::norm(corners[at] - corners[at - 1]));
		if (i >= board.columns)
			least = std::min(least,
					 cv::norm(corners[at] - corners[at - static_cast<size_t>(board.columns)]));
	}
	return least;
}

// How much a place looks like a corner of four squares: opposite quarters alike, neighbours different; grey levels.
double saddle(const cv::Mat &picture, const cv::Point2f &at, const cv::Point2f &across, const cv::Point2f &down)
{
	double levels[4];
	for (int i = 0; i < 4; i++) {
		const float a = i & 1 ? 0.3f : -0.3f, b = i & 2 ? 0.3f : -0.3f;
		const cv::Point place = at + a * across + b * down;
		if (!cv::Rect(cv::Point(), picture.size()).contains(place))
			return 0;
		levels[i] = picture.at<uchar>(place);
	}
	return std::abs(levels[0] + levels[3] - levels[1] - levels[2]) / 2 - std::abs(levels[0] - levels[3]) -
	       std::abs(levels[1] - levels[2]);
}

// Whether the squares go on beyond the corners of one side: then the board has more than was said. A row is continued
// by as much as its last step.
bool goes_on(const cv::Mat &picture, const Corners &corners, int first, int step, int inward, int count)
{
	int like = 0;
	for (int i = 0; i < count; i++) {
		const int at = first + i * step, next = i + 1 < count ? at + step : at - step;
		const cv::Point2f corner = corners[static_cast<size_t>(at)];
		const cv::Point2f outward = corner - corners[static_cast<size_t>(at + inward)];
		const cv::Point2f along = corners[static_cast<size_t>(next)] - corner;
		like += saddle(picture, corner + outward, outward, along) > 20;
	}
	return like * 2 > count;
}

bool larger_than_said(const cv::Mat &picture, const Corners &corners, const BoardSize &board)
{
	const int columns = board.columns, rows = board.rows;
	return goes_on(picture, corners, 0, 1, columns, columns) ||
	       goes_on(picture, corners, (rows - 1) * columns, 1, -columns, columns) ||
	       goes_on(picture, corners, 0, columns, 1, rows) ||
	       goes_on(picture, corners, columns - 1, columns, -1, rows);
}

// How wide the edge between two neighbouring corners is: the step of grey levels across it over its greatest slope, px.
// 0 where there is no step.
double edge_width(const cv::Mat &picture, const cv::Point2f &a, const cv::Point2f &b)
{
	const cv::Point2f middle = (a + b) / 2, along = b - a;
	const float length = static_cast<float>(cv::norm(along));
	const cv::Point2f across(-along.y / length, along.x / length);
	const int reach = std::max(2, static_cast<int>(0.4f * length));
	std::vector<double> levels;
	for (int i = -reach; i <= reach; i++) {
		cv::Mat level;
		cv::getRectSubPix(picture, {1, 1}, middle + static_cast<float>(i) * across, level);
		levels.push_back(level.at<uchar>(0, 0));
	}
	double slope = 0;
	for (size_t i = 1; i < levels.size(); i++)
		slope = std::max(slope, std::abs(levels[i] - levels[i - 1]));
	return slope > 5 ? std::abs(levels.back() - levels.front()) / slope : 0;
}

// The mean width of the edges along the rows or along the columns, whichever is blurred more: motion blurs one of them.
double blur_of(const cv::Mat &picture, const Corners &corners, const BoardSize &board)
{
	double sum[2] = {};
	int count[2] = {};
	for (int i = 0; i < board.rows * board.columns; i++)
		for (const int step : {1, board.columns}) {
			if (step == 1 ? i % board.columns == 0 : i < board.columns)
				continue;
			const bool down = step != 1;
			sum[down] += edge_width(picture, corners[static_cast<size_t>(i)],
						corners[static_cast<size_t>(i - step)]);
			count[down]++;
		}
	return std::max(sum[0] / count[0], sum[1] / count[1]);
}

// What the picture shows where the board was not found: any board of at least 3 x 3.
std::string explain(const cv::Mat &picture, const BoardSize &board)
{
	Corners corners;
	cv::Mat grid;
	const int flags = cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_LARGER;
	if (!cv::findChessboardCornersSB(picture, {3, 3}, corners, flags, grid))
		return "no board found: not in the picture, too blurred, or too small";
	const int columns = std::max(grid.cols, grid.rows), rows = std::min(grid.cols, grid.rows);
	const int wanted = std::max(board.columns, board.rows), wanted_rows = std::min(board.columns, board.rows);
	const char *reason = columns <= wanted && rows <= wanted_rows
				     ? "cut off, covered, or a smaller board"
				     : "the board is not of the size that --board says";
	return pong::format("only %d x %d inner corners are seen: %s", columns, rows, reason);
}

} // namespace

Found find_board(const cv::Mat &picture, const BoardSize &board)
{
	Found found;
	Corners corners;
	const cv::Size size(board.columns, board.rows);
	const int flags = cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE;
	if (!cv::findChessboardCorners(picture, size, corners, flags | cv::CALIB_CB_FAST_CHECK) &&
	    !cv::findChessboardCornersSB(picture, size, corners, cv::CALIB_CB_NORMALIZE_IMAGE)) {
		found.why = explain(picture, board);
		return found;
	}
	make_upright(board, corners);
	const double step = least_step(corners, board);
	const int half = std::clamp(static_cast<int>(step * 0.35), 2, 11);
	cv::cornerSubPix(picture, corners, {half, half}, {-1, -1},
			 {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 0.001});
	const double edge = blur_of(picture, corners, board);
	if (larger_than_said(picture, corners, board))
		found.why = "the board has more corners than --board says";
	else if (edge > std::max(blur_limit * step, 5.0))
		found.why = pong::format("blurred: edges are %.1f pixels wide", edge);
	else
		found.corners = corners;
	return found;
}

void order_alike(const Corners &model, const BoardSize &board, Corners &corners)
{
	if (along_rows(model, board).dot(along_rows(corners, board)) < 0)
		std::reverse(corners.begin(), corners.end());
	if (board.columns != board.rows)
		return;
	// A square board may also be a quarter of a turn off: take the turn whose rows run most alike.
	Corners best = corners, turned = corners;
	const auto alike = [&](const Corners &these) {
		const cv::Point2f a = along_rows(model, board), b = along_rows(these, board);
		return a.dot(b) / (cv::norm(a) * cv::norm(b));
	};
	for (int quarter = 0; quarter < 3; quarter++) {
		const Corners before = turned;
		for (int row = 0; row < board.rows; row++)
			for (int column = 0; column < board.columns; column++)
				turned[static_cast<size_t>(row * board.columns + column)] =
					before[static_cast<size_t>((board.rows - 1 - column) * board.columns + row)];
		if (alike(turned) > alike(best))
			best = turned;
	}
	corners = best;
}

} // namespace calibrate
