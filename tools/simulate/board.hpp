// The calibration board: a chessboard, and the poses that it is shown in.
//
// Board frame: origin in the first inner corner, x along the columns, y along the rows, z through the board away from
// whoever looks at it. Inner corner (i, j) lies at (i square, j square, 0), as in OpenCV's examples.
#pragma once

#include <vector>

#include "camera.hpp"
#include "scene.hpp"

namespace sim
{

struct BoardPose {
	Eigen::Matrix3d R_table_board;
	Eigen::Vector3d origin; // of the board frame, table frame, m
	double plane_z;         // of an upright board; NaN for any other pose, m
};

// First the board that lies on the table, aligned with it; then upright boards at the planes that the settings name,
// with tilted ones between them. All poses but those of the planes are wholly in view of both cameras.
std::vector<BoardPose> draw_poses(const BoardSettings &settings, const Rig &rig, uint64_t seed);

// The four outer corners of the board with its white margin, table frame.
std::vector<Eigen::Vector3d> outline(const BoardSettings &settings, const BoardPose &pose);

// What a ray that comes from outside meets of the board. False where it passes by.
bool look_at_board(const BoardSettings &settings, const BoardPose &pose, const Ray &ray, double *level);

} // namespace sim
