// The most probable flight: right within its own covariance, in long flights, beside outliers, with unknown noise.
#include <cmath>
#include <gtest/gtest.h>

#include "flights.hpp"
#include "lib/estimate.hpp"

namespace
{

using Covariance = Eigen::Matrix<double, PONG_STATE_SIZE, PONG_STATE_SIZE>;

pong_state estimate(const pong_rig &rig, const std::vector<pong_point> &points)
{
	pong::Estimate estimate(rig, 0);
	for (const pong_point &point : points)
		estimate.add(point);
	estimate.settle();
	pong_state state = {};
	EXPECT_TRUE(estimate.state(&state));
	return state;
}

double position_error(const pong_state &state, const sim::Flight &flight)
{
	const sim::Ball truth = flight.at(static_cast<double>(state.utime - 1000000) * 1e-6);
	return (Eigen::Map<const Eigen::Vector3d>(state.position) - truth.position).norm();
}

// Of position and velocity, by its six dimensions: 1 on average.
double normalised_error(const pong_state &state, const sim::Flight &flight)
{
	const double time = static_cast<double>(state.utime - 1000000) * 1e-6, step = 1e-4;
	Eigen::Matrix<double, 6, 1> error;
	error.head<3>() = Eigen::Map<const Eigen::Vector3d>(state.position) - flight.at(time).position;
	error.tail<3>() = Eigen::Map<const Eigen::Vector3d>(state.velocity) -
			  (flight.at(time + step).position - flight.at(time - step).position) / (2 * step);
	const Eigen::Matrix<double, 6, 6> covariance =
		Eigen::Map<const Covariance>(&state.covariance[0][0]).topLeftCorner<6, 6>();
	return error.dot(covariance.ldlt().solve(error)) / 6;
}

double mean_normalised_error(double end, double rate)
{
	const pong_rig rig = rig_of_simulator();
	const sim::Flight flight = fly(usual_serve());
	double sum = 0;
	for (unsigned seed = 1; seed <= 40; seed++)
		sum += normalised_error(estimate(rig, points_of(flight, 0, end, rate, 0.003, seed)), flight);
	return sum / 40;
}

TEST(Estimate, ItsCovarianceIsTrue)
{
	EXPECT_NEAR(mean_normalised_error(0.3, 110), 1, 0.3);
}

TEST(Estimate, AndAfterTheBounce)
{
	EXPECT_NEAR(mean_normalised_error(0.6, 110), 1, 0.3);
}

// 240 points do not fit into the window: the older ones are folded, the bounce among them.
TEST(Estimate, ALongFlightIsFoldedWithoutLoss)
{
	EXPECT_NEAR(mean_normalised_error(0.6, 400), 1, 0.3);
}

TEST(Estimate, FindsTheSpinAfterTheBounce)
{
	const sim::Flight flight = fly(usual_serve());
	const pong_state state = estimate(rig_of_simulator(), points_of(flight, 0, 0.65, 110, 0.001));
	const Eigen::Vector3d truth = flight.at(0.6).spin;
	for (int axis = 0; axis < 3; axis++) {
		const double sigma = std::sqrt(state.covariance[PONG_STATE_SPIN + axis][PONG_STATE_SPIN + axis]);
		EXPECT_LT(sigma, 40);
		EXPECT_NEAR(state.spin[axis], truth[axis], 3.5 * sigma);
	}
}

// Calibration that is wrong by some millimetres puts the table's surface there: the bounce tells.
// Believed to roll, where friction is of no account, the ball slides in truth.
TEST(Estimate, FindsASlipperyTable)
{
	pong_rig rig = rig_of_simulator();
	rig.ball.friction_sigma = 0.05;
	sim::Coefficients slippery;
	slippery.friction = 0.11;
	sim::Ball ball = usual_serve();
	ball.spin = {-150, 20, 60};
	const sim::Flight flight = fly(ball, slippery);
	const pong_state state = estimate(rig, points_of(flight, 0, 0.65, 110, 0.001));
	EXPECT_NEAR(state.coefficients[PONG_STATE_FRICTION - PONG_STATE_DRAG], 0.11, 0.03);
	EXPECT_LT(position_error(state, flight), 0.002);
	EXPECT_LT(normalised_error(state, flight), 4);
}

TEST(Estimate, FindsTheTableWhereTheCamerasSeeIt)
{
	const sim::Flight flight = fly(usual_serve());
	auto points = points_of(flight, 0, 0.6, 110, 0.001);
	for (pong_point &point : points)
		point.position[1] -= 0.004;
	pong_rig rig = rig_of_simulator();
	rig.ball.restitution_sigma = 0.03;
	rig.table.height_sigma = 0.003;
	const pong_state state = estimate(rig, points);
	const double sigma = std::sqrt(state.covariance[PONG_STATE_HEIGHT][PONG_STATE_HEIGHT]);
	EXPECT_LT(sigma, 0.001);
	EXPECT_NEAR(state.coefficients[PONG_STATE_HEIGHT - PONG_STATE_DRAG], -0.004, 3 * sigma);
	const double truth = flight.at(static_cast<double>(state.utime - 1000000) * 1e-6).velocity.y();
	EXPECT_NEAR(state.velocity[1], truth, 3 * std::sqrt(state.covariance[4][4]));
	rig.table.height_sigma = 0;
	EXPECT_GT(std::abs(estimate(rig, points).velocity[1] - truth), 2 * std::abs(state.velocity[1] - truth));
}

// Without a new fit the velocity with one more point is nearly that of the fit: of what the point tells, most.
TEST(Estimate, TheVelocityWithOneMorePointNeedsNoFit)
{
	const pong_rig rig = rig_of_simulator();
	pong_settings settings;
	pong_settings_defaults(PONG_BEST, &settings);
	const sim::Flight flight = fly(usual_serve());
	for (const double end : {0.06, 0.15, 0.3, 0.55}) {
		double step = 0, missed = 0;
		for (unsigned seed = 1; seed <= 20; seed++) {
			std::vector<pong_point> points = points_of(flight, 0, end, 110, 0.003, seed);
			const Eigen::Vector3d fitted(estimate(rig, points).velocity);
			const pong_point last = points.back();
			points.pop_back();
			const pong_state before = estimate(rig, points);
			pong_state predicted;
			ASSERT_TRUE(pong_predict_at(&rig, &before, last.utime, &settings, &predicted));
			step += (fitted - Eigen::Vector3d(predicted.velocity)).squaredNorm();
			missed += (fitted - pong::velocity_given(predicted, last)).squaredNorm();
		}
		EXPECT_LT(missed, 0.05 * step) << end;
	}
}

TEST(Estimate, AnOutlierCountsLittle)
{
	const pong_rig rig = rig_of_simulator();
	const sim::Flight flight = fly(usual_serve());
	auto points = points_of(flight, 0, 0.3, 110, 0.002);
	const double before = position_error(estimate(rig, points), flight);
	points[15].position[1] += 0.2;
	EXPECT_LT(position_error(estimate(rig, points), flight), before + 0.002);
}

TEST(Estimate, FindsUnknownNoiseOut)
{
	const pong_rig rig = rig_of_simulator();
	const sim::Flight flight = fly(usual_serve());
	auto points = points_of(flight, 0, 0.35, 110, 0.02);
	for (pong_point &point : points)
		for (auto &row : point.covariance)
			std::fill(std::begin(row), std::end(row), 0);
	EXPECT_LT(normalised_error(estimate(rig, points), flight), 3);
}

TEST(Estimate, TwoPointsAreEnoughForWideBounds)
{
	const sim::Flight flight = fly(usual_serve());
	const pong_state state = estimate(rig_of_simulator(), points_of(flight, 0, 0.015, 110, 0.003));
	EXPECT_NEAR(state.velocity[2], -7.5, 3 * std::sqrt(state.covariance[5][5]));
	EXPECT_GT(state.covariance[5][5], 0.01);
}

} // namespace
