// A camera taken apart: what the stages need of pong_camera, as matrices.
#pragma once

#include <Eigen/Dense>

#include "pongeye.h"

namespace pong
{

using Vector2 = Eigen::Vector2d;
using Vector3 = Eigen::Vector3d;
using Matrix2 = Eigen::Matrix2d;
using Matrix3 = Eigen::Matrix3d;
using Matrix34 = Eigen::Matrix<double, 3, 4>;

inline Matrix34 matrix_of(const double P[3][4])
{
	return Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(&P[0][0]);
}

inline Vector3 vector_of(const double position[3])
{
	return {position[0], position[1], position[2]};
}

inline void store(const Vector3 &vector, double out[3])
{
	Eigen::Map<Vector3>{out} = vector;
}

inline void store(const Matrix34 &matrix, double P[3][4])
{
	Eigen::Map<Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>{&P[0][0]} = matrix;
}

inline void store(const Matrix3 &matrix, double out[3][3])
{
	Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>{&out[0][0]} = matrix;
}

// P = K R [I | -centre], with K upper triangular and its diagonal positive.
struct Camera {
	explicit Camera(const pong_camera &camera);

	// Pixels of a point in the camera frame's z = 1 plane, lens distortion included.
	Vector2 distort(const Vector2 &normal) const;
	// The inverse, by Newton's method.
	Vector2 undistort(const Vector2 &pixel) const;
	// A perfect lens' pixel.
	Vector2 ideal_pixel(const Vector2 &normal) const;
	// The ray that a pixel sees: a unit vector in the table frame.
	Vector3 ray(const Vector2 &pixel) const;
	// Depth along the optical axis, m.
	double depth(const Vector3 &position) const;
	// Where it is seen; only for depth > 0.
	Vector2 project(const Vector3 &position) const;
	// The diameter in pixels of a sphere of that diameter (m) at that depth (m).
	double apparent_size(double diameter, double at_depth) const;

	Matrix3 K, R;
	Vector3 centre;
	double k1, k2, p1, p2, k3;
	bool perfect; // no distortion
};

} // namespace pong
