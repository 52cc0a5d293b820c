// OpenCV's way of calibrating, on the same corners.
#pragma once

#include <vector>

#include "pongeye.h"

namespace bench
{

struct PictureSize {
	int width, height;
};

// cv::calibrateCamera for each camera on the placed boards, which give the frame too, by cv::solvePnP. False where it
// fails.
bool calibrate_each(const std::vector<pong_view> &views, const std::vector<pong_corner> &corners, PictureSize size,
		    pong_camera camera[2]);

// The same, then cv::stereoCalibrate of both, on what both cameras saw of all boards. The frame is the left camera's
// where no board is placed. k3 is held at 0.
bool calibrate_stereo(const std::vector<pong_view> &views, const std::vector<pong_corner> &corners, PictureSize size,
		      pong_camera camera[2]);

} // namespace bench
