#include "pictures.hpp"

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <map>
#include <thread>
#include <unistd.h>

#include <opencv2/imgcodecs.hpp>

#include "pongeye.h"
#include "program.hpp"

namespace calibrate
{

namespace
{

// A file's name without folder, ending and its side's word.
std::string common_name(const std::string &path, const std::string &side)
{
	std::string name = std::filesystem::path(path).stem().string();
	const size_t at = name.find(side);
	if (at == std::string::npos)
		return "";
	name.erase(at, side.size());
	while (!name.empty() && (name.back() == '-' || name.back() == '_'))
		name.pop_back();
	return name;
}

// By common name; empty where a name has none, or two files have the same.
std::map<std::string, std::string> by_name(const std::vector<std::string> &files, const char *side)
{
	std::map<std::string, std::string> result;
	for (const std::string &file : files) {
		const std::string name = common_name(file, side);
		if (name.empty() || !result.emplace(name, file).second)
			return {};
	}
	return result;
}

Pair named_pair(const std::string &name, const std::string &left, const std::string &right)
{
	Pair pair;
	pair.name = name;
	pair.file = {left, right};
	return pair;
}

cv::Mat read_picture(const std::string &file)
{
	const cv::Mat picture = cv::imread(file, cv::IMREAD_GRAYSCALE);
	if (picture.empty())
		throw pong::Failure(file + ": not a picture that can be read");
	return picture;
}

void show_progress(size_t done, size_t all)
{
	if (isatty(STDERR_FILENO) || done == all)
		fprintf(stderr, "%slooking for boards: %zu of %zu pictures%s", isatty(STDERR_FILENO) ? "\r" : "", done,
			all, done == all ? "\n" : "");
}

void find_in_pair(const BoardSize &board, Pair &pair)
{
	for (size_t side = 0; side < 2; side++) {
		if (pair.picture[side].empty())
			pair.found[side].why = "there is no picture";
		else
			pair.found[side] = find_board(pair.picture[side], board);
	}
	if (!pair.found[0].corners.empty() && !pair.found[1].corners.empty())
		order_alike(pair.found[0].corners, board, pair.found[1].corners);
	if (pair.found[0].corners.empty() && pair.found[1].corners.empty())
		pair.rejected = pair.found[0].why == pair.found[1].why
					? "both: " + pair.found[0].why
					: "left: " + pair.found[0].why + "; right: " + pair.found[1].why;
}

} // namespace

std::vector<Pair> pair_files(const std::vector<std::string> &left, const std::vector<std::string> &right)
{
	std::vector<Pair> pairs;
	const auto left_names = by_name(left, "left"), right_names = by_name(right, "right");
	if (left_names.empty() || right_names.empty()) {
		if (left.size() != right.size())
			throw pong::Failure(
				pong::format("%zu left and %zu right pictures, whose names do not tell which "
					     "belong together",
					     left.size(), right.size()));
		for (size_t i = 0; i < left.size(); i++)
			pairs.push_back(named_pair(std::filesystem::path(left[i]).stem(), left[i], right[i]));
		return pairs;
	}
	// In the order in which the left ones were given; what only the right camera has comes last.
	for (const std::string &file : left) {
		const std::string name = common_name(file, "left");
		const auto other = right_names.find(name);
		pairs.push_back(named_pair(name, file, other == right_names.end() ? "" : other->second));
	}
	for (const auto &[name, file] : right_names)
		if (!left_names.count(name))
			pairs.push_back(named_pair(name, "", file));
	return pairs;
}

void find_boards(const BoardSize &board, std::vector<Pair> &pairs)
{
	cv::Size size[2];
	for (Pair &pair : pairs)
		for (size_t side = 0; side < 2; side++) {
			if (pair.file[side].empty())
				continue;
			cv::Mat &picture = pair.picture[side] = read_picture(pair.file[side]);
			if (size[side].empty())
				size[side] = picture.size();
			if (picture.size() != size[side])
				throw pong::Failure(
					pong::format("%s: %d x %d pixels, but the first picture has %d x %d",
						     pair.file[side].c_str(), picture.cols, picture.rows,
						     size[side].width, size[side].height));
		}
	std::atomic<size_t> next{0}, done{0};
	const auto work = [&] {
		for (size_t i = next++; i < pairs.size() && !pong::stop_requested(); i = next++) {
			find_in_pair(board, pairs[i]);
			done += 2;
		}
	};
	cv::setNumThreads(1);
	std::vector<std::thread> threads;
	for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); i++)
		threads.emplace_back(work);
	while (isatty(STDERR_FILENO) && done < 2 * pairs.size() && !pong::stop_requested()) {
		show_progress(done, 2 * pairs.size());
		usleep(100000);
	}
	for (std::thread &thread : threads)
		thread.join();
	if (pong::stop_requested())
		throw pong::Failure("stopped");
	show_progress(done, 2 * pairs.size());
}

} // namespace calibrate
