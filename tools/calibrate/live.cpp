#include "live.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <opencv2/imgcodecs.hpp>

#include "../track/cameras.hpp"
#include "../track/capture_settings.hpp"
#include "program.hpp"
#include "session.hpp"
#include "volume.hpp"

namespace calibrate
{

namespace
{

const int look_every_us = 150000; // finding a board takes longer than a picture lasts
const double still = 0.3;         // a board whose corners move less from look to look is still, px rms
const double fresh = 0.05;        // and in a new pose if they are farther from every kept one, parts of the width
const size_t least_pairs = 4;     // for a calibration

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

// Where the picture is bare, and whether boards are tilted: what tells enough for a first calibration.
std::string wanted_first(const std::vector<Pair> &kept, const BoardSize &board)
{
	const auto tilted = std::count_if(kept.begin(), kept.end(), [&](const Pair &pair) {
		return tilt_of(pair.found[0].corners, board) > 0.05;
	});
	const bool flat = static_cast<size_t>(2 * tilted) < kept.size();
	return "the " + wanted_place(kept) + " of the left picture" +
	       (flat ? ", the board tilted by 30 degrees or more" : "");
}

// The pose that would make points the most certain, by the calibration that the kept pairs give in the left camera's
// frame; empty where they give none yet.
std::string wanted_most(const std::vector<Pair> &kept, const BoardSize &board)
{
	Arguments arguments;
	arguments.board = board;
	arguments.no_table = true;
	Session session;
	session.pairs = kept;
	try {
		solve(arguments, session);
	} catch (const pong::Failure &) {
		return "";
	}
	const auto grid = volume_grid(session, false);
	const auto advice = advise(session, board, grid);
	if (advice.empty())
		return "";
	return pong::format("a board %s: points would be %.2f mm off, now %.2f", advice.front().text.c_str(),
			    advice.front().mean, expect_error(session.calibration, grid).mean);
}

void tell_wanted(const std::vector<Pair> &kept, const Arguments &arguments)
{
	const bool done = kept.size() >= static_cast<size_t>(arguments.pairs);
	std::string wanted;
	if (!done && kept.size() >= least_pairs)
		wanted = wanted_most(kept, arguments.board);
	if (wanted.empty())
		wanted = wanted_first(kept, arguments.board);
	fprintf(stderr, "%zu of %d pairs%s\n", kept.size(), arguments.pairs,
		done ? "" : ("; wanted next: " + wanted).c_str());
}

// As --left and --right take them.
void save(const std::string &folder, const Pair &pair)
{
	if (folder.empty())
		return;
	std::error_code error;
	std::filesystem::create_directories(folder, error);
	for (const size_t side : {0, 1}) {
		const std::string path = folder + "/" + pair.name + (side ? "-right.png" : "-left.png");
		if (!cv::imwrite(path, pair.picture[side]))
			throw pong::Failure(path + ": cannot be written");
	}
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
	while (kept.size() < static_cast<size_t>(arguments.pairs) && !pong::stop_requested()) {
		track::StereoPair pictures;
		const track::Next next = source->next(pictures);
		if (next == track::Next::END)
			break;
		if (next == track::Next::NOTHING_YET)
			source->wait();
		if (next != track::Next::PAIR || pictures.utime < next_look)
			continue;
		next_look = pictures.utime + look_every_us;
		Pair pair = look(pictures, arguments.board);
		if (both_found(pair) && both_found(before) &&
		    distance(pair.found[0].corners, before.found[0].corners) < still && is_new(kept, pair)) {
			pair.name = pong::format("live-%02zu", kept.size() + 1);
			save(arguments.save, pair);
			kept.push_back(pair);
			tell_wanted(kept, arguments);
		}
		before = pair;
	}
	if (kept.size() < least_pairs)
		throw pong::Failure(pong::format("only %zu pairs were collected: %zu are needed at least", kept.size(),
						 least_pairs));
	return kept;
}

} // namespace calibrate
