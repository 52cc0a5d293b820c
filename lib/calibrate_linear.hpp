// What can be had of cameras and boards by linear equations alone.
#pragma once

#include <vector>

#include "calibrate_model.hpp"

namespace pong
{

// One pixel and the place of what is seen there, in whatever frame.
struct Sighted {
	Vector3 place;
	Vector2 pixel;
};

// The paper's direct method: P from points at known places that do not lie in one plane (eq. 3 to 7), scaled so that w
// is the depth. Throws Fault where they do.
Matrix34 direct_projection(const std::vector<Sighted> &points, pong_normalisation normalisation);

// The homography from a board's x, y to pixels, by Hartley's normalised linear method. False where the points lie on a
// line.
bool board_homography(const std::vector<Sighted> &points, Matrix3 &H);

// The focal length (px) that makes the columns of all homographies orthogonal and alike (Zhang 2000, eq. 3 and 4, with
// square pixels and the principal point at `middle`). 0 where the boards do not tell: all parallel to the picture.
double focal_length(const std::vector<Matrix3> &homographies, const Vector2 &middle);

// The pose of a board in the camera's frame, from its homography and K.
Pose board_pose(const Matrix3 &H, const Matrix3 &K);

} // namespace pong
