// OpenCV's ways to find a ball and its centre.
#pragma once

#include <opencv2/core.hpp>

#include "pongeye.h"

namespace bench
{

enum class Rival { moments, enclosing_circle, ellipse, hough };

const char *rival_name(Rival rival);

// The largest contour of |current - earlier| > threshold inside of `where`, and its centre. False where there is none.
bool find_by_contour(const pong_pictures &pictures, const cv::Rect &where, Rival rival, double uv[2]);

// cv::triangulatePoints.
void triangulate_by_opencv(const pong_rig &rig, const double left[2], const double right[2], double position[3]);

} // namespace bench
