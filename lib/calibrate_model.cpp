#include "calibrate_model.hpp"

#include <cmath>

namespace pong
{

Matrix3 cross_matrix(const Vector3 &d)
{
	Matrix3 matrix;
	matrix << 0, -d.z(), d.y(), d.z(), 0, -d.x(), -d.y(), d.x(), 0;
	return matrix;
}

Matrix3 rotation(const Vector3 &vector)
{
	const double angle = vector.norm();
	if (angle < 1e-12)
		return Matrix3::Identity() + cross_matrix(vector);
	return Eigen::AngleAxisd(angle, vector / angle).toRotationMatrix();
}

Vector3 rotation_vector(const Matrix3 &R)
{
	const Eigen::AngleAxisd turn(R);
	return turn.angle() * turn.axis();
}

Vector3 Pose::operator*(const Vector3 &point) const
{
	return R * point + t;
}

Pose Pose::operator*(const Pose &other) const
{
	return {R * other.R, R * other.t + t};
}

Pose Pose::inverse() const
{
	return {R.transpose(), -(R.transpose() * t)};
}

Pose Pose::moved(const PoseStep &step) const
{
	return {rotation(step.head<3>()) * R, t + step.tail<3>()};
}

Pose pose_of(const double pose[3][4])
{
	const Matrix34 matrix = matrix_of(pose);
	return {matrix.leftCols<3>(), matrix.col(3)};
}

void store(const Pose &pose, double out[3][4])
{
	Matrix34 matrix;
	matrix << pose.R, pose.t;
	store(matrix, out);
}

CameraModel::CameraModel(const pong_camera &camera)
{
	const Camera parts(camera);
	lens << parts.K(0, 0), parts.K(1, 1), parts.K(0, 2), parts.K(1, 2), parts.k1, parts.k2, parts.p1, parts.p2,
		parts.k3;
	R = parts.R;
	centre = parts.centre;
}

void CameraModel::store_in(pong_camera &camera) const
{
	Matrix3 K;
	K << lens[0], 0, lens[2], 0, lens[1], lens[3], 0, 0, 1;
	Matrix34 P;
	P << K * R, -(K * (R * centre));
	store(P, camera.P);
	for (int i = 0; i < 5; i++)
		camera.distortion[i] = lens[4 + i];
}

Pose CameraModel::pose() const
{
	return {R, -(R * centre)};
}

CameraModel CameraModel::moved(const CameraStep &step) const
{
	CameraModel camera = *this;
	camera.lens += step.head<9>();
	camera.R = rotation(step.segment<3>(9)) * R;
	camera.centre += step.tail<3>();
	return camera;
}

// Brown's model about (x, y), the point in the plane z = 1 of the camera frame, and its derivatives. A small rotation w
// about the camera's axes moves the point by w x q, the centre by dc moves it by -R dc.
Projection project(const CameraModel &camera, const Vector3 &point)
{
	Projection result = {};
	const Vector3 q = camera.R * (point - camera.centre);
	result.ahead = q.z() > 0;
	if (!result.ahead)
		return result;
	const auto &lens = camera.lens;
	const double fu = lens[0], fv = lens[1], k1 = lens[4], k2 = lens[5], p1 = lens[6], p2 = lens[7], k3 = lens[8];
	const double x = q.x() / q.z(), y = q.y() / q.z(), r2 = x * x + y * y;
	const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
	const double slope = 2 * (k1 + r2 * (2 * k2 + r2 * 3 * k3)); // of radial, per x dx + y dy
	const double x_seen = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
	const double y_seen = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
	result.pixel = {fu * x_seen + lens[2], fv * y_seen + lens[3]};

	Matrix2 by_normal;
	by_normal << radial + x * x * slope + 2 * p1 * y + 6 * p2 * x, x * y * slope + 2 * p1 * x + 2 * p2 * y,
		x * y * slope + 2 * p1 * x + 2 * p2 * y, radial + y * y * slope + 6 * p1 * y + 2 * p2 * x;
	Eigen::Matrix<double, 2, 3> normal_by_q;
	normal_by_q << 1 / q.z(), 0, -x / q.z(), 0, 1 / q.z(), -y / q.z();
	const Eigen::Matrix<double, 2, 3> by_q = Vector2(fu, fv).asDiagonal() * by_normal * normal_by_q;

	result.by_point = by_q * camera.R;
	auto &by_camera = result.by_camera;
	by_camera.row(0).head<9>() << x_seen, 0, 1, 0, fu * x * r2, fu * x * r2 * r2, fu * 2 * x * y,
		fu * (r2 + 2 * x * x), fu * x * r2 * r2 * r2;
	by_camera.row(1).head<9>() << 0, y_seen, 0, 1, fv * y * r2, fv * y * r2 * r2, fv * (r2 + 2 * y * y),
		fv * 2 * x * y, fv * y * r2 * r2 * r2;
	by_camera.middleCols<3>(9) = -(by_q * cross_matrix(q));
	by_camera.rightCols<3>() = -result.by_point;
	return result;
}

} // namespace pong
