// The simulator's own cameras: a pinhole with OpenCV's lens distortion, and the rig that two of them make.
//
// Table frame: x to the robot's left, y up, z towards the opponent. Camera frame: x right, y down, z forward.
// Pixel (0, 0) is the centre of the top left pixel.
#pragma once

#include <array>
#include <string>

#include <Eigen/Core>

namespace sim
{

struct Camera {
	int width = 640, height = 480; // px
	double focal;                  // px
	Eigen::Vector2d principal;     // px
	Eigen::Matrix3d R_cam_table;
	Eigen::Vector3d centre;                // of projection, table frame, m
	std::array<double, 5> distortion = {}; // OpenCV's k1 k2 p1 p2 k3

	Eigen::Vector3d to_camera(const Eigen::Vector3d &point) const;

	// Where a point of the table frame is seen, px. False where no lens shows it: behind the camera, or so far
	// off the axis that the distortion polynomial turns back.
	bool project(const Eigen::Vector3d &point, Eigen::Vector2d *uv) const;

	// The ideal image point (x / z, y / z in the camera frame) that pixel uv sees.
	Eigen::Vector2d ideal(const Eigen::Vector2d &uv) const;

	// P: pixels of a perfect lens from the table frame, scaled so that the third row gives the depth in metres.
	Eigen::Matrix<double, 3, 4> projection() const;
};

// Forward lens model on ideal image points. False where the radial part is no longer monotonic.
bool distort(const std::array<double, 5> &distortion, const Eigen::Vector2d &ideal, Eigen::Vector2d *distorted);

// Its inverse, by fixed-point iteration.
Eigen::Vector2d undistort(const std::array<double, 5> &distortion, const Eigen::Vector2d &distorted);

// Two parallel cameras behind the robot's end of the table, as in the paper (section 2).
struct RigSettings {
	int width = 640, height = 480;         // px
	double focal = 8 / 0.0074;             // 8 mm lens over 7.4 um pixels, px
	double baseline = 0.18;                // m
	double behind = 0.4;                   // the cameras stand this far behind the table's end, m,
	double above = 0.5;                    // this far above its surface, m,
	double pitch = 13;                     // and look this much down, degrees
	std::array<double, 5> distortion = {}; // of both lenses
};

using Rig = std::array<Camera, 2>; // left, right

Rig make_rig(const RigSettings &settings);

// The rig as rig.toml; `hit_z` is the plane on which the robot hits, m.
std::string rig_text(const Rig &rig, double hit_z);

} // namespace sim
