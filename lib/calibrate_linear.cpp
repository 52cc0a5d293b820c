// The paper's normalised direct linear method (section 3), and Zhang's homographies where boards stand anyhow.
#include "calibrate_linear.hpp"

#include <cmath>

#include "error.hpp"

namespace pong
{

namespace
{

// q~ = (q - E) / D for every coordinate (eq. 4 and 5), as a matrix for homogeneous coordinates.
template<int size> struct Normaliser {
	using Vector = Eigen::Matrix<double, size, 1>;
	Vector mean = Vector::Zero(), spread = Vector::Ones();

	Normaliser(const std::vector<Vector> &points, pong_normalisation normalisation)
	{
		if (normalisation == PONG_NORMALISE_NONE)
			return;
		for (const Vector &point : points)
			mean += point / static_cast<double>(points.size());
		Vector variance = Vector::Zero();
		for (const Vector &point : points)
			variance += (point - mean).cwiseAbs2() / static_cast<double>(points.size());
		spread = normalisation == PONG_NORMALISE_VARIANCE ? variance : variance.cwiseSqrt().eval();
		spread = (spread.array() > 0).select(spread, 1);
	}

	Vector operator()(const Vector &point) const
	{
		return (point - mean).cwiseQuotient(spread);
	}

	Eigen::Matrix<double, size + 1, size + 1> matrix() const
	{
		Eigen::Matrix<double, size + 1, size + 1> result;
		result.setIdentity();
		result.template topLeftCorner<size, size>() = spread.cwiseInverse().asDiagonal();
		result.template topRightCorner<size, 1>() = -mean.cwiseQuotient(spread);
		return result;
	}
};

template<class Part, class Get> std::vector<Part> parts_of(const std::vector<Sighted> &points, Get get)
{
	std::vector<Part> parts;
	for (const Sighted &point : points)
		parts.push_back(get(point));
	return parts;
}

// M with m34 = 1 from M = (A'A)^-1 A'B (eq. 3); two rows a point.
Matrix34 solve_direct(const std::vector<Vector3> &places, const std::vector<Vector2> &pixels)
{
	Eigen::Matrix<double, 11, 11> normal = Eigen::Matrix<double, 11, 11>::Zero();
	Eigen::Matrix<double, 11, 1> right_side = Eigen::Matrix<double, 11, 1>::Zero();
	for (size_t i = 0; i < places.size(); i++)
		for (int axis = 0; axis < 2; axis++) {
			Eigen::Matrix<double, 11, 1> row = Eigen::Matrix<double, 11, 1>::Zero();
			row.segment<4>(4 * axis) = places[i].homogeneous();
			row.tail<3>() = -pixels[i][axis] * places[i];
			normal += row * row.transpose();
			right_side += row * pixels[i][axis];
		}
	const Eigen::LDLT<Eigen::Matrix<double, 11, 11>> solver(normal);
	const auto pivots = solver.vectorD();
	if (!(pivots.minCoeff() > 1e-14 * pivots.maxCoeff()))
		throw Fault{PONG_ERROR_VALUE, "the placed boards all lie in one plane: the paper's method needs two"};
	const Eigen::Matrix<double, 11, 1> m = solver.solve(right_side);
	Matrix34 M;
	M << m.segment<4>(0).transpose(), m.segment<4>(4).transpose(), m.tail<3>().transpose(), 1;
	return M;
}

} // namespace

Matrix34 direct_projection(const std::vector<Sighted> &points, pong_normalisation normalisation)
{
	if (points.size() < 6)
		throw Fault{PONG_ERROR_VALUE, "fewer than 6 corners on placed boards: the paper's method needs more"};
	auto places = parts_of<Vector3>(points, [](const Sighted &point) { return point.place; });
	auto pixels = parts_of<Vector2>(points, [](const Sighted &point) { return point.pixel; });
	const Normaliser<3> G(places, normalisation);
	const Normaliser<2> L(pixels, normalisation);
	for (Vector3 &place : places)
		place = G(place);
	for (Vector2 &pixel : pixels)
		pixel = L(pixel);
	Matrix34 M = L.matrix().inverse() * solve_direct(places, pixels) * G.matrix(); // eq. 7
	M /= M.row(2).head<3>().norm();
	return M.leftCols<3>().determinant() < 0 ? -M : M;
}

bool board_homography(const std::vector<Sighted> &points, Matrix3 &H)
{
	if (points.size() < 4)
		return false;
	const auto places =
		parts_of<Vector2>(points, [](const Sighted &point) { return point.place.head<2>().eval(); });
	const auto pixels = parts_of<Vector2>(points, [](const Sighted &point) { return point.pixel; });
	const Normaliser<2> G(places, PONG_NORMALISE_DEVIATION), L(pixels, PONG_NORMALISE_DEVIATION);
	Eigen::Matrix<double, 9, 9> normal = Eigen::Matrix<double, 9, 9>::Zero();
	for (size_t i = 0; i < points.size(); i++) {
		const Vector3 place = G(places[i]).homogeneous();
		const Vector2 pixel = L(pixels[i]);
		for (int axis = 0; axis < 2; axis++) {
			Eigen::Matrix<double, 9, 1> row = Eigen::Matrix<double, 9, 1>::Zero();
			row.segment<3>(3 * axis) = place;
			row.tail<3>() = -pixel[axis] * place;
			normal += row * row.transpose();
		}
	}
	const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> solver(normal);
	if (!(solver.eigenvalues()[1] > 1e-12 * solver.eigenvalues()[8]))
		return false;
	const Eigen::Matrix<double, 9, 1> h = solver.eigenvectors().col(0);
	H << h.segment<3>(0).transpose(), h.segment<3>(3).transpose(), h.tail<3>().transpose();
	H = L.matrix().inverse() * H * G.matrix();
	return std::abs(H.determinant()) > 0;
}

// With pixels from the middle, w = diag(1, 1, f^2) / f^2 is the image of the absolute conic: h1' w h2 = 0 and
// h1' w h1 = h2' w h2 are linear in g = 1 / f^2: a g + b = 0. Each equation weighs by its homography's size.
double focal_length(const std::vector<Matrix3> &homographies, const Vector2 &middle)
{
	Matrix3 to_middle = Matrix3::Identity();
	to_middle.topRightCorner<2, 1>() = -middle;
	double aa = 0, ab = 0;
	for (const Matrix3 &homography : homographies) {
		const Matrix3 H = to_middle * homography;
		const double size = H.col(0).head<2>().norm() * H.col(1).head<2>().norm();
		const double a[2] = {H.col(0).head<2>().dot(H.col(1).head<2>()) / size,
				     (H.col(0).head<2>().squaredNorm() - H.col(1).head<2>().squaredNorm()) / size};
		const double b[2] = {H(2, 0) * H(2, 1) / size, (H(2, 0) * H(2, 0) - H(2, 1) * H(2, 1)) / size};
		for (int i = 0; i < 2; i++) {
			aa += a[i] * a[i];
			ab += a[i] * b[i];
		}
	}
	return aa > 1e-6 && ab < 0 ? std::sqrt(-aa / ab) : 0;
}

// K^-1 H = s [r1 r2 t]; the board is in front of the camera, and R the nearest rotation.
Pose board_pose(const Matrix3 &H, const Matrix3 &K)
{
	Matrix3 B = K.inverse() * H;
	B *= 2 / (B.col(0).norm() + B.col(1).norm());
	if (B(2, 2) < 0)
		B = -B;
	Matrix3 R;
	R << B.col(0), B.col(1), B.col(0).cross(B.col(1));
	const Eigen::JacobiSVD<Matrix3> svd(R, Eigen::ComputeFullU | Eigen::ComputeFullV);
	return {svd.matrixU() * svd.matrixV().transpose(), B.col(2)};
}

} // namespace pong
