// The corners of a chessboard in a picture, or why there are none.
#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace calibrate
{

// Inner corners.
struct BoardSize {
	int columns, rows;
	double square; // m
};

struct Found {
	std::vector<cv::Point2f> corners; // row by row; empty where the board was not found
	std::string why;                  // it was not, in a few words
};

// Find the board. The first corner is the upper left one as the picture shows it, rows run to the right.
Found find_board(const cv::Mat &picture, const BoardSize &board);

// Put the corners that one camera saw into the order of the other's, whose rows run the same way: a board that is
// turned by half a turn, or stands on its side, may look the other way round to one of two cameras.
void order_alike(const std::vector<cv::Point2f> &model, const BoardSize &board, std::vector<cv::Point2f> &corners);

} // namespace calibrate
