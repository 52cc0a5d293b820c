// The table's four corners in a picture, by its white lines: found freely or from rough places, and then to a part of a
// pixel.
//
// Corners are those of the lines' outer edges, in this order: near left, near right, far right, far left, as the robot
// sees them.
#pragma once

#include <array>
#include <vector>

#include <opencv2/core.hpp>

namespace calibrate
{

using TableCorners = std::array<cv::Point2d, 4>;

struct TableSight {
	TableCorners corners;          // NaN: beyond the picture's border
	std::vector<cv::Point2d> edge; // points of the outer edges that the corners follow from
	std::array<double, 4> rms;     // of the points about the near, right, far, left edge, px
};

// From corners that are off by a few pixels; one beyond the border is given where it would be. Throws pong::Failure
// where a side is not seen as a white line.
TableSight refine_table(const cv::Mat &picture, const TableCorners &rough);

// Roughly, from nothing: the largest quadrangle of white lines that lies as a table would. Throws pong::Failure where
// there is none.
TableCorners find_table(const cv::Mat &picture);

} // namespace calibrate
