// The joint refinement: both cameras, every board's pose and shape, by robust least squares under priors.
#pragma once

#include <array>
#include <vector>

#include "calibrate_model.hpp"

namespace pong
{

// A board in one pair of pictures.
struct Board {
	Pose pose;
	bool placed = false;
	Pose placement;
	double sigma_position = 0, sigma_angle = 0, sigma_shape = 0;
	std::vector<Vector3> points; // where they should be on the board
	Eigen::MatrixXd bend;        // how they deviate from it: points + bend * shape; no columns: rigid
	Eigen::VectorXd shape;

	// Where a point is, in the board frame.
	Vector3 point(int number) const;
	// How many numbers describe the board: pose and shape.
	int numbers() const;
	Board moved(const Eigen::VectorXd &step) const;
};

// The deformations of points that are no rigid motion, orthonormal: what is left is the least squares fit of the stated
// shape, so that a frame is not moved by a shape.
Eigen::MatrixXd deformations(const std::vector<Vector3> &points);

struct Seen {
	int board, side, point;
	Vector2 pixel;
	double spread; // its noise over sigma
};

// What is known of the lens before any picture: a number about its usual value. The aspect is of fu - fv, in parts of
// fu.
struct LensPrior {
	double width[2] = {}, height[2] = {};
	double aspect = 0, principal = 0, distortion[5] = {};
};

struct Problem {
	std::array<CameraModel, 2> camera;
	std::vector<Board> boards;
	std::vector<Seen> seen;
	LensPrior prior;
	std::array<bool, rig_numbers> held = {}; // numbers of the rig that stay as they are
	double sigma = 1;                        // of a corner, per axis, px
	double loss = 3;                         // Huber's threshold, in sigma
};

// Seen minus expected, px; huge where a camera looks away.
Vector2 residual(const Problem &problem, const Seen &seen);

// Minimise by Levenberg and Marquardt, every step with the boards eliminated (Schur), re-estimating sigma until it
// stands still. Returns false where no step helps and the problem is still far from a minimum.
void solve(Problem &problem);

// The covariance of the rig at the minimum, in the order of PONG_CAMERA_NUMBERS; zero for what is held. Throws Fault
// where something is not determined.
RigMatrix rig_covariance(const Problem &problem);

// And the poses of the boards, given that of the rig.
std::vector<Eigen::Matrix<double, 6, 6>> board_covariances(const Problem &problem, const RigMatrix &rig);

// What a rigid board adds to the information on the rig when its pose is unknown: A - W V^-1 W'.
RigMatrix information_of_board(const Problem &problem);

} // namespace pong
