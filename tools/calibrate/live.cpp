#include "live.hpp"

#include <algorithm>
#include <cmath>

#include "../track/cameras.hpp"
#include "../track/capture_settings.hpp"
#include "program.hpp"

namespace calibrate
{

namespace
{

const int look_every_us = 150000; // finding a board takes longer than a picture lasts
const double still = 0.3;         // a board whose corners move less from look to look is still, px rms
const double fresh = 0.05;        // and in a new pose if they are farther from every kept one, parts of the width
const size_t enough = 24;         // pairs

double distance(const std::vector<cv::Point2f> &a, const std::vector<cv::Point2f> &b)
{
	double squares = 0;
	for (size_t i = 0; i < a.size(); i++)
		squares += (a[i] - b[i]).dot(a[i] - b[i]);
	return std::sqrt(squares / static_cast<double>(a.size()));
}

cv::Mat copy_of(const pong_image &image)
{
	return cv::Mat(image.height, image.width, CV_8U, const_cast<uint8_t *>(image.pixels),
		       static_cast<size_t>(image.stride))
		.clone();
}

// The ninth of the picture that the kept boards' corners cover least.
std::string wanted_place(const std::vector<Pair> &kept)
{
	int corners[9] = {};
	for (const Pair &pair : kept)
		for (const cv::Point2f &corner : pair.found[0].corners) {
			const int column = std::clamp(static_cast<int>(3 * corner.x) / pair.picture[0].cols, 0, 2);
			const int row = std::clamp(static_cast<int>(3 * corner.y) / pair.picture[0].rows, 0, 2);
			corners[3 * row + column]++;
		}
	const char *rows[] = {"upper", "middle", "lower"}, *columns[] = {"left", "middle", "right"};
	const auto least = std::min_element(corners, corners + 9) - corners;
	return pong::format("%s %s", rows[least / 3], columns[least % 3]);
}

// How far the board is tilted against the picture: how unequal its opposite sides look.
double tilt_of(const std::vector<cv::Point2f> &corners, const BoardSize &board)
{
	const size_t columns = static_cast<size_t>(board.columns), last = corners.size() - 1;
	const auto ratio = [&](size_t a, size_t b, size_t c, size_t d) {
		return std::abs(std::log(cv::norm(corners[a] - corners[b]) / cv::norm(corners[c] - corners[d])));
	};
	return std::max(ratio(0, columns - 1, last - columns + 1, last),
			ratio(0, last - columns + 1, columns - 1, last));
}

void tell_wanted(const std::vector<Pair> &kept, const BoardSize &board)
{
	const auto tilted = std::count_if(kept.begin(), kept.end(), [&](const Pair &pair) {
		return tilt_of(pair.found[0].corners, board) > 0.05;
	});
	fprintf(stderr, "%zu of %zu pairs; wanted next: the %s of the left picture%s\n", kept.size(), enough,
		wanted_place(kept).c_str(),
		static_cast<size_t>(2 * tilted) < kept.size() ? ", the board tilted by 30 degrees or more" : "");
}

bool is_new(const std::vector<Pair> &kept, const Pair &pair)
{
	const double least = fresh * pair.picture[0].cols;
	return std::all_of(kept.begin(), kept.end(), [&](const Pair &other) {
		return distance(other.found[0].corners, pair.found[0].corners) > least;
	});
}

Pair look(const track::StereoPair &pictures, const BoardSize &board)
{
	Pair pair;
	pair.picture = {copy_of(pictures.left), copy_of(pictures.right)};
	for (size_t side = 0; side < 2; side++) {
		pair.found[side] = find_board(pair.picture[side], board);
		if (pair.found[side].corners.empty())
			return pair;
	}
	order_alike(pair.found[0].corners, board, pair.found[1].corners);
	return pair;
}

bool both_found(const Pair &pair)
{
	return !pair.found[0].corners.empty() && !pair.found[1].corners.empty();
}

} // namespace

std::vector<Pair> collect(const Arguments &arguments)
{
	pong_rig rig;
	pong_error error;
	if (pong_rig_load(arguments.cameras.c_str(), &rig, &error) < 0)
		throw pong::Failure(error.text);
	const auto source = track::open_cameras(rig, track::load_capture_settings(arguments.cameras));
	std::vector<Pair> kept;
	Pair before;
	int64_t next_look = 0;
	while (kept.size() < enough && !pong::stop_requested()) {
		track::StereoPair pictures;
		const track::Next next = source->next(pictures);
		if (next == track::Next::END)
			break;
		if (next == track::Next::NOTHING_YET || pictures.utime < next_look)
			continue;
		next_look = pictures.utime + look_every_us;
		Pair pair = look(pictures, arguments.board);
		if (both_found(pair) && both_found(before) &&
		    distance(pair.found[0].corners, before.found[0].corners) < still && is_new(kept, pair)) {
			pair.name = pong::format("live-%02zu", kept.size() + 1);
			kept.push_back(pair);
			tell_wanted(kept, arguments.board);
		}
		before = pair;
	}
	if (kept.size() < 4)
		throw pong::Failure(pong::format("only %zu pairs were collected: 4 are needed at least", kept.size()));
	return kept;
}

} // namespace calibrate
