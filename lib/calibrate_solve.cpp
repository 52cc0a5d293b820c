// Normal equations of a rig and its boards:
//
//     | A   W1  W2 .. | | rig step     |   | a  |
//     | W1' V1        | | board 1 step | = | v1 |      A: 30 x 30, Vi: 6 x 6 (more where a board bends)
//     | W2'     V2    | | board 2 step |   | v2 |
//
// Boards share nothing but the rig, so each is eliminated by itself: (A - sum Wi Vi^-1 Wi') rig = a - sum Wi Vi^-1 vi.
#include "calibrate_solve.hpp"

#include <algorithm>
#include <cmath>

#include "error.hpp"

namespace pong
{

namespace
{

// Sharper than any placement is, and yet far from the limits of double precision: 1 um, 1 urad.
const double least_sigma = 1e-6;

struct Normal {
	RigMatrix A = RigMatrix::Zero();
	RigStep a = RigStep::Zero();
	std::vector<Eigen::MatrixXd> V, W;
	std::vector<Eigen::VectorXd> v;
	double cost = 0;
};

// A step of everything: the rig's and every board's.
struct Step {
	RigStep rig;
	std::vector<Eigen::VectorXd> boards;
};

// Huber: the square up to the threshold, from there on a straight line; and the weight that stands for it.
double loss_of(double distance, double threshold)
{
	return distance <= threshold ? distance * distance : 2 * threshold * distance - threshold * threshold;
}

double weight_of(double distance, double threshold)
{
	return distance <= threshold ? 1 : threshold / distance;
}

// What is known before: row . step = missing, +- sigma. A sigma of 0 knows nothing.
void add_prior(Normal &normal, const RigStep &row, double missing, double sigma)
{
	if (sigma <= 0)
		return;
	normal.A += row * row.transpose() / (sigma * sigma);
	normal.a += row * (missing / (sigma * sigma));
	normal.cost += missing * missing / (sigma * sigma);
}

void add_lens_prior(const Problem &problem, size_t side, Normal &normal)
{
	const auto &lens = problem.camera[side].lens;
	const LensPrior &prior = problem.prior;
	const auto unit = [&](int number) { return RigStep(RigStep::Unit(int(side) * camera_numbers + number)); };
	const double off_centre = prior.principal * prior.width[side];
	add_prior(normal, unit(0) - unit(1), lens[1] - lens[0], prior.aspect * lens[0]);
	add_prior(normal, unit(2), (prior.width[side] - 1) / 2 - lens[2], off_centre);
	add_prior(normal, unit(3), (prior.height[side] - 1) / 2 - lens[3], off_centre);
	for (int i = 0; i < 5; i++)
		add_prior(normal, unit(4 + i), -lens[4 + i], prior.distortion[i]);
}

void add_board_prior(const Board &board, Eigen::MatrixXd &V, Eigen::VectorXd &v, double &cost)
{
	const auto add = [&](int first, const Eigen::VectorXd &missing, double sigma) {
		const double weight = 1 / (sigma * sigma);
		V.diagonal().segment(first, missing.size()).array() += weight;
		v.segment(first, missing.size()) += weight * missing;
		cost += weight * missing.squaredNorm();
	};
	if (board.placed) {
		add(0, rotation_vector(board.placement.R * board.pose.R.transpose()),
		    std::max(board.sigma_angle, least_sigma));
		add(3, board.placement.t - board.pose.t, std::max(board.sigma_position, least_sigma));
	}
	if (board.shape.size())
		add(pose_numbers, -board.shape, board.sigma_shape);
}

// Of a pixel by the numbers of its board. A small rotation about the table frame's axes moves the point by
// w x (R b).
Eigen::MatrixXd by_board(const Board &board, int point, const Eigen::Matrix<double, 2, 3> &by_point)
{
	Eigen::MatrixXd jacobian(2, board.numbers());
	jacobian.leftCols<3>() = -(by_point * cross_matrix(board.pose.R * board.point(point)));
	jacobian.middleCols<3>(3) = by_point;
	if (board.shape.size())
		jacobian.rightCols(board.shape.size()) = by_point * board.pose.R * board.bend.middleRows(3 * point, 3);
	return jacobian;
}

void add_seen(const Problem &problem, const Seen &seen, Normal &normal)
{
	const auto board_number = static_cast<size_t>(seen.board);
	const Board &board = problem.boards[board_number];
	const Projection projection =
		project(problem.camera[static_cast<size_t>(seen.side)], board.pose * board.point(seen.point));
	const double sigma = problem.sigma * seen.spread;
	const Vector2 missing = residual(problem, seen) / sigma;
	normal.cost += loss_of(missing.norm(), problem.loss);
	if (!projection.ahead)
		return;
	const double weight = weight_of(missing.norm(), problem.loss);
	const auto by_camera = (projection.by_camera / sigma).eval();
	const Eigen::MatrixXd by_numbers = by_board(board, seen.point, projection.by_point / sigma);
	const int first = seen.side * camera_numbers;
	normal.A.block<camera_numbers, camera_numbers>(first, first) += weight * by_camera.transpose() * by_camera;
	normal.a.segment<camera_numbers>(first) += weight * by_camera.transpose() * missing;
	normal.V[board_number] += weight * by_numbers.transpose() * by_numbers;
	normal.v[board_number] += weight * by_numbers.transpose() * missing;
	normal.W[board_number].middleRows<camera_numbers>(first) += weight * by_camera.transpose() * by_numbers;
}

Normal normal_equations(const Problem &problem)
{
	Normal normal;
	for (const Board &board : problem.boards) {
		normal.V.emplace_back(Eigen::MatrixXd::Zero(board.numbers(), board.numbers()));
		normal.v.emplace_back(Eigen::VectorXd::Zero(board.numbers()));
		normal.W.emplace_back(Eigen::MatrixXd::Zero(rig_numbers, board.numbers()));
		add_board_prior(board, normal.V.back(), normal.v.back(), normal.cost);
	}
	for (size_t side = 0; side < 2; side++)
		add_lens_prior(problem, side, normal);
	for (const Seen &seen : problem.seen)
		add_seen(problem, seen, normal);
	return normal;
}

double cost_of(const Problem &problem)
{
	Normal normal;
	Eigen::MatrixXd V;
	Eigen::VectorXd v;
	for (const Board &board : problem.boards) {
		V.setZero(board.numbers(), board.numbers());
		v.setZero(board.numbers());
		add_board_prior(board, V, v, normal.cost);
	}
	for (size_t side = 0; side < 2; side++)
		add_lens_prior(problem, side, normal);
	for (const Seen &seen : problem.seen)
		normal.cost += loss_of(residual(problem, seen).norm() / (problem.sigma * seen.spread), problem.loss);
	return normal.cost;
}

// The boards eliminated. Numbers that are held keep a row of their own, which leaves them where they are.
RigMatrix reduced(const Problem &problem, const Normal &normal, const std::vector<Eigen::MatrixXd> &V_inverse)
{
	RigMatrix S = normal.A;
	for (size_t i = 0; i < V_inverse.size(); i++)
		S -= normal.W[i] * V_inverse[i] * normal.W[i].transpose();
	for (int number = 0; number < rig_numbers; number++)
		if (problem.held[static_cast<size_t>(number)]) {
			S.row(number).setZero();
			S.col(number).setZero();
			S(number, number) = 1;
		}
	return S;
}

// Inverse by way of unit diagonal: pixels, radians and metres differ by many orders of magnitude. False where it has
// none.
template<class Matrix> bool invert(const Matrix &matrix, Matrix &inverse)
{
	if (!(matrix.diagonal().minCoeff() > 0))
		return false;
	const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
	const Matrix scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
	const Eigen::LDLT<Matrix> solver(scaled);
	if (!(solver.vectorD().minCoeff() > 1e-14))
		return false;
	inverse = solver.solve(Matrix::Identity(matrix.rows(), matrix.cols()));
	inverse = (scale.asDiagonal() * inverse * scale.asDiagonal()).eval();
	return true;
}

// A step with every diagonal raised by the part `damping` (Marquardt).
bool damped_step(const Problem &problem, const Normal &normal, double damping, Step &step)
{
	Normal damped = normal;
	damped.A.diagonal() *= 1 + damping;
	std::vector<Eigen::MatrixXd> V_inverse(damped.V.size());
	for (size_t i = 0; i < damped.V.size(); i++) {
		damped.V[i].diagonal() *= 1 + damping;
		if (!invert(damped.V[i], V_inverse[i]))
			return false;
	}
	RigStep right_side = damped.a;
	for (size_t i = 0; i < V_inverse.size(); i++)
		right_side -= damped.W[i] * (V_inverse[i] * damped.v[i]);
	for (int number = 0; number < rig_numbers; number++)
		if (problem.held[static_cast<size_t>(number)])
			right_side[number] = 0;
	RigMatrix inverse;
	if (!invert(reduced(problem, damped, V_inverse), inverse))
		return false;
	step.rig = inverse * right_side;
	step.boards.clear();
	for (size_t i = 0; i < V_inverse.size(); i++)
		step.boards.push_back(V_inverse[i] * (damped.v[i] - damped.W[i].transpose() * step.rig));
	return true;
}

Problem moved(const Problem &problem, const Step &step)
{
	Problem result = problem;
	for (int side = 0; side < 2; side++)
		result.camera[static_cast<size_t>(side)] = problem.camera[static_cast<size_t>(side)].moved(
			step.rig.segment<camera_numbers>(side * camera_numbers));
	for (size_t i = 0; i < step.boards.size(); i++)
		result.boards[i] = problem.boards[i].moved(step.boards[i]);
	return result;
}

// Levenberg and Marquardt with sigma as it is.
void minimise(Problem &problem)
{
	double damping = 1e-4;
	for (int iteration = 0; iteration < 200; iteration++) {
		const Normal normal = normal_equations(problem);
		double gain = -1;
		while (gain < 0 && damping < 1e12) {
			Step step;
			if (damped_step(problem, normal, damping, step)) {
				const Problem next = moved(problem, step);
				gain = normal.cost - cost_of(next);
				if (gain >= 0)
					problem = next;
			}
			damping = gain >= 0 ? std::max(damping / 10, 1e-12) : damping * 10;
		}
		if (gain < 1e-9 * (normal.cost + 1))
			return;
	}
}

// Half of all distances are below it; for a Gaussian that is 1.18 sigma per axis.
double median_sigma(const Problem &problem)
{
	std::vector<double> distances;
	for (const Seen &seen : problem.seen)
		distances.push_back(residual(problem, seen).norm() / seen.spread);
	const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
	std::nth_element(distances.begin(), middle, distances.end());
	return *middle / std::sqrt(2 * std::log(2.0));
}

// From the weighted squares, for as many numbers as were fitted to them. Placed boards' poses are not counted: their
// priors stand for them.
double redundant_sigma(const Problem &problem)
{
	double squares = 0, weights = 0;
	for (const Seen &seen : problem.seen) {
		const double distance = residual(problem, seen).norm() / seen.spread;
		const double weight = weight_of(distance / problem.sigma, problem.loss);
		squares += weight * distance * distance;
		weights += 2 * weight;
	}
	double fitted = static_cast<double>(std::count(problem.held.begin(), problem.held.end(), false));
	for (const Board &board : problem.boards)
		fitted += board.placed ? 0 : board.numbers();
	return std::sqrt(squares / std::max(weights - fitted, 1.0));
}

} // namespace

Vector3 Board::point(int number) const
{
	const Vector3 &stated = points[static_cast<size_t>(number)];
	return shape.size() ? Vector3(stated + bend.middleRows<3>(3 * number) * shape) : stated;
}

int Board::numbers() const
{
	return pose_numbers + static_cast<int>(shape.size());
}

Board Board::moved(const Eigen::VectorXd &step) const
{
	Board board = *this;
	board.pose = pose.moved(step.head<pose_numbers>());
	board.shape += step.tail(shape.size());
	return board;
}

Eigen::MatrixXd deformations(const std::vector<Vector3> &points)
{
	const auto count = static_cast<Eigen::Index>(points.size());
	Eigen::MatrixXd rigid(3 * count, 6);
	for (Eigen::Index i = 0; i < count; i++)
		rigid.middleRows<3>(3 * i) << Matrix3::Identity(), cross_matrix(points[static_cast<size_t>(i)]);
	const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rigid, Eigen::ComputeFullU);
	return svd.matrixU().rightCols(3 * count - 6);
}

Vector2 residual(const Problem &problem, const Seen &seen)
{
	const Board &board = problem.boards[static_cast<size_t>(seen.board)];
	const Projection projection =
		project(problem.camera[static_cast<size_t>(seen.side)], board.pose * board.point(seen.point));
	return projection.ahead ? Vector2(seen.pixel - projection.pixel) : Vector2(1e6, 1e6);
}

void solve(Problem &problem)
{
	for (int round = 0; round < 3; round++) {
		problem.sigma = std::max(median_sigma(problem), 1e-4);
		minimise(problem);
	}
	for (int round = 0; round < 10; round++) {
		const double sigma = std::max(redundant_sigma(problem), 1e-4);
		const bool settled = std::abs(sigma - problem.sigma) < 1e-4 * sigma;
		problem.sigma = sigma;
		minimise(problem);
		if (settled)
			return;
	}
}

RigMatrix rig_covariance(const Problem &problem)
{
	const Normal normal = normal_equations(problem);
	std::vector<Eigen::MatrixXd> V_inverse(normal.V.size());
	for (size_t i = 0; i < normal.V.size(); i++)
		if (!invert(normal.V[i], V_inverse[i]))
			throw Fault{PONG_ERROR_VALUE,
				    sentence("the corners of view %zu do not tell where it stood", i)};
	RigMatrix covariance;
	if (!invert(reduced(problem, normal, V_inverse), covariance))
		throw Fault{PONG_ERROR_VALUE, "the views do not determine the two cameras: add boards in other poses"};
	for (int number = 0; number < rig_numbers; number++)
		if (problem.held[static_cast<size_t>(number)])
			covariance(number, number) = 0;
	return covariance;
}

// V^-1 + V^-1 W' C W V^-1: what the corners leave, and what the rig adds.
std::vector<Eigen::Matrix<double, 6, 6>> board_covariances(const Problem &problem, const RigMatrix &rig)
{
	const Normal normal = normal_equations(problem);
	std::vector<Eigen::Matrix<double, 6, 6>> covariances;
	for (size_t i = 0; i < normal.V.size(); i++) {
		Eigen::MatrixXd V_inverse;
		if (!invert(normal.V[i], V_inverse))
			throw Fault{PONG_ERROR_VALUE,
				    sentence("the corners of view %zu do not tell where it stood", i)};
		const Eigen::MatrixXd gain = normal.W[i] * V_inverse;
		covariances.emplace_back((V_inverse + gain.transpose() * rig * gain).topLeftCorner<6, 6>());
	}
	return covariances;
}

RigMatrix information_of_board(const Problem &problem)
{
	const Normal normal = normal_equations(problem);
	Eigen::MatrixXd V_inverse;
	if (!invert(normal.V.front(), V_inverse))
		return RigMatrix::Zero();
	return normal.A - normal.W.front() * V_inverse * normal.W.front().transpose();
}

} // namespace pong
