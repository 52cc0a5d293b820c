// The pictures of a calibration, pair by pair, and the boards found in them.
#pragma once

#include <array>

#include "corners.hpp"

namespace calibrate
{

struct Pair {
	std::string name;                // what both files' names have in common, for people
	std::array<std::string, 2> file; // by pong_side; empty where there is none
	std::array<cv::Mat, 2> picture;  // grey
	std::array<Found, 2> found;
	std::string rejected; // why the whole pair is not used; empty where it is
};

// Files of the left and of the right camera become pairs by their names, which differ in the words left and right (or l
// and r) only; where names tell nothing, by their order. Throws pong::Failure.
std::vector<Pair> pair_files(const std::vector<std::string> &left, const std::vector<std::string> &right);

// Read the pictures and find the board in each, on all cores, with progress on stderr. Throws pong::Failure for a file
// that is no picture, or of another size than the first.
void find_boards(const BoardSize &board, std::vector<Pair> &pairs);

} // namespace calibrate
