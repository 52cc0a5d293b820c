// A simulated calibration: two cameras, boards before them, and the corners that are seen, with the truth. The
// projection is its own: nothing here is the library's.
#pragma once

#include <random>
#include <vector>

#include <Eigen/Dense>

#include "pongeye.h"

namespace pong
{

// A camera with a lens, taken apart.
struct TrueCamera {
	double fu, fv, cu, cv, k1, k2, p1, p2;
	Eigen::Matrix3d R; // camera frame from table frame
	Eigen::Vector3d centre;

	// False where the point is not in the picture.
	bool see(const Eigen::Vector3d &point, Eigen::Vector2d &pixel) const;
};

struct TrueRig {
	TrueCamera camera[2];
};

const int true_width = 640, true_height = 480;

// The paper's rig, with the small misalignments that any real one has, and lenses with this k1.
TrueRig true_rig(double k1);

// The paper's board.
struct BoardShape {
	int columns = 11, rows = 8;
	double square = 0.030;
};

// What happened during a simulated calibration.
struct Session {
	double noise = 0.1;    // of a corner, per axis, px
	double placement = 0;  // of a plane, per axis, m
	double tilt = 0;       // of a plane, about each axis, rad
	int boards = 20;       // held at will, besides the planes
	bool planes = true;    // at z = 0.2, 0.4, 0.6, 0.8 m
	double farthest = 2.5; // distance of boards held at will, m; the nearest is 0.6
	BoardShape shape;
};

struct Recording {
	std::vector<pong_view> views;
	std::vector<pong_corner> corners;
	std::vector<Eigen::Matrix4d> poses; // where the boards truly stood
};

Recording record(const TrueRig &rig, const Session &session, std::mt19937_64 &random);

// 60 positions over the table that both cameras see: three heights, five distances, four across.
std::vector<Eigen::Vector3d> table_volume();

// How far a rig's points are from the truth, m: the mean and the root of the mean square over positions.
struct VolumeError {
	double mean, rms;
};

VolumeError volume_error(const TrueRig &truth, const pong_camera camera[2],
			 const std::vector<Eigen::Vector3d> &positions);

// What a calibration itself expects of that rms, m; NaN where it knows no covariance.
double expected_error(const pong_calibration &calibration, const std::vector<Eigen::Vector3d> &positions);

} // namespace pong
