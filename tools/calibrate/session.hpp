// From found boards to a calibration: views and corners for the library, and pictures that spoil it left out.
#pragma once

#include <string>
#include <vector>

#include "arguments.hpp"
#include "pictures.hpp"
#include "pongeye.h"
#include "table_corners.hpp"

namespace calibrate
{

// The table's corners, where they set the frame. Of those that were found in pictures, the pictures and the points of
// the outline too.
struct TableView {
	bool given = false;
	std::string name; // of the pair; empty where the corners were given in pixels
	std::array<cv::Mat, 2> picture;
	std::array<TableCorners, 2> corners;
	std::array<std::vector<cv::Point2d>, 2> edge;
};

// A calibration and all that went into it. Views are those pairs that were used, in order, and the table's corners last
// where they were given.
struct Session {
	std::vector<Pair> pairs;
	std::vector<size_t> used; // the pair of each view
	TableView table;
	std::vector<pong_view> views;
	std::vector<pong_corner> corners;
	pong_calibration calibration = {};
	std::vector<pong_view_result> results;
	std::vector<std::array<double, 2>> residuals;
	std::vector<std::string> notes; // what people should know of it
};

// The library's views and corners of the pairs that are not rejected.
void build_views(const Arguments &arguments, Session &session);

// Calibrate, leaving out pictures that do not fit the others. Throws pong::Failure.
void solve(const Arguments &arguments, Session &session);

// Score cameras on the pictures. Returns the rms, px.
double score(const pong_camera camera[2], Session &session);

// The mean side of the squares as the cameras measure them: neighbouring corners that both see, reconstructed, m. NaN
// where there are none.
double measured_square(const pong_camera camera[2], const BoardSize &board, const Session &session);

} // namespace calibrate
