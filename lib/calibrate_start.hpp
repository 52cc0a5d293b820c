// A first guess of cameras and boards, from linear methods.
#pragma once

#include "calibrate_solve.hpp"

namespace pong
{

// Fill in problem.camera and the poses of problem.boards from problem.seen, problem.boards' placements and
// problem.prior's picture sizes. Where no board is placed the table frame is the left camera's. Throws Fault where that
// is not possible.
void start(Problem &problem);

// Fill in the poses of problem.boards for the cameras as they are.
void start_boards(Problem &problem);

// The table frame in the camera, when the frame stands in the camera: x left, y up, z along the axis.
Matrix3 camera_from_own_table();

} // namespace pong
