// The cameras and boards of a calibration as they move under a small step, and how pixels follow.
#pragma once

#include <vector>

#include "camera.hpp"

namespace pong
{

constexpr int camera_numbers = PONG_CAMERA_NUMBERS, rig_numbers = 2 * PONG_CAMERA_NUMBERS, pose_numbers = 6;

using CameraStep = Eigen::Matrix<double, camera_numbers, 1>;
using RigStep = Eigen::Matrix<double, rig_numbers, 1>;
using RigMatrix = Eigen::Matrix<double, rig_numbers, rig_numbers>;
using PoseStep = Eigen::Matrix<double, pose_numbers, 1>;

// [d]x: cross_matrix(d) * e = d x e.
Matrix3 cross_matrix(const Vector3 &d);

// The rotation about a vector by its length, and back (Rodrigues).
Matrix3 rotation(const Vector3 &vector);
Vector3 rotation_vector(const Matrix3 &R);

// X = R b + t.
struct Pose {
	Matrix3 R = Matrix3::Identity();
	Vector3 t = Vector3::Zero();

	Vector3 operator*(const Vector3 &point) const;
	Pose operator*(const Pose &other) const;
	Pose inverse() const;
	// Turned about the origin of what is posed, in the target frame: R' = exp(rotation) R, t' = t + translation.
	Pose moved(const PoseStep &step) const;
};

Pose pose_of(const double pose[3][4]);
void store(const Pose &pose, double out[3][4]);

// A camera by the numbers of PONG_CAMERA_NUMBERS.
struct CameraModel {
	Eigen::Matrix<double, 9, 1> lens = Eigen::Matrix<double, 9, 1>::Zero(); // fu fv cu cv k1 k2 p1 p2 k3
	Matrix3 R = Matrix3::Identity();
	Vector3 centre = Vector3::Zero();

	CameraModel() = default;
	// The skew of a K that has one is dropped.
	explicit CameraModel(const pong_camera &camera);
	// Into P and distortion; id and size stay.
	void store_in(pong_camera &camera) const;

	// Table frame to camera frame.
	Pose pose() const;
	CameraModel moved(const CameraStep &step) const;
};

// Where a point of the table frame is seen, and the derivatives of that. A point behind the camera has none: `ahead`
// is false.
struct Projection {
	bool ahead;
	Vector2 pixel;
	Eigen::Matrix<double, 2, camera_numbers> by_camera;
	Eigen::Matrix<double, 2, 3> by_point;
};

Projection project(const CameraModel &camera, const Vector3 &point);

} // namespace pong
