// What a calibration's covariance does to a reconstructed point.
#include <cmath>
#include <limits>

#include "calibrate_solve.hpp"

using namespace pong;

namespace
{

bool in_picture(const pong_camera &camera, const Vector3 &position, double uv[2])
{
	return pong_project(&camera, position.data(), uv) == PONG_FOUND && uv[0] >= 0 && uv[1] >= 0 &&
	       uv[0] <= camera.width - 1 && uv[1] <= camera.height - 1;
}

// The point nearest to both rays, weighed as pixels are: d point = H^-1 J' (-d pixel), with J the derivatives of both
// pixels by the point, and d pixel by the rig.
Eigen::Matrix<double, 3, rig_numbers> point_by_rig(const pong_calibration &calibration, const Vector3 &position)
{
	Eigen::Matrix<double, 4, 3> by_point;
	Eigen::Matrix<double, 4, rig_numbers> by_rig = Eigen::Matrix<double, 4, rig_numbers>::Zero();
	for (int side = 0; side < 2; side++) {
		const Projection projection = project(CameraModel(calibration.camera[side]), position);
		by_point.middleRows<2>(2 * side) = projection.by_point;
		by_rig.block<2, camera_numbers>(2 * side, side * camera_numbers) = projection.by_camera;
	}
	return -(by_point.transpose() * by_point).inverse() * by_point.transpose() * by_rig;
}

RigMatrix covariance_of(const pong_calibration &calibration)
{
	return Eigen::Map<const RigMatrix>(&calibration.covariance[0][0]);
}

} // namespace

int pong_calibration_error(const pong_calibration *calibration, const double position[3], double covariance[3][3])
{
	const Vector3 point = vector_of(position);
	double uv[2];
	if (!in_picture(calibration->camera[PONG_LEFT], point, uv) ||
	    !in_picture(calibration->camera[PONG_RIGHT], point, uv))
		return PONG_NONE;
	const auto by_rig = point_by_rig(*calibration, point);
	store(Matrix3(by_rig * covariance_of(*calibration) * by_rig.transpose()), covariance);
	return PONG_FOUND;
}

// The new covariance is C - C B (1 + B' C B)^-1 B' C for information B B': nothing is inverted that might be singular,
// as C is where numbers are held.
void pong_calibration_expect(const pong_calibration *before, const double pose[3][4], const pong_corner *corners,
			     int corner_count, pong_calibration *after)
{
	Problem problem;
	problem.sigma = before->sigma;
	Board board;
	board.pose = pose_of(pose);
	for (int side = 0; side < 2; side++)
		problem.camera[static_cast<size_t>(side)] = CameraModel(before->camera[side]);
	for (int i = 0; i < corner_count; i++) {
		board.points.push_back(vector_of(corners[i].board));
		const Projection projection =
			project(problem.camera[static_cast<size_t>(corners[i].side)], board.pose * board.points.back());
		if (projection.ahead)
			problem.seen.push_back({0, corners[i].side, i, projection.pixel, 1});
	}
	problem.boards.push_back(board);
	const RigMatrix C = covariance_of(*before);
	const Eigen::SelfAdjointEigenSolver<RigMatrix> parts(information_of_board(problem));
	const RigMatrix B = parts.eigenvectors() * parts.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal();
	const RigMatrix inner = RigMatrix::Identity() + B.transpose() * C * B;
	const RigMatrix CB = C * B;
	*after = *before;
	Eigen::Map<RigMatrix>(&after->covariance[0][0]) = C - CB * inner.ldlt().solve(CB.transpose());
}
