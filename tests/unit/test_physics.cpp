// The ball's physics: its rates against differences, its steps against the simulator's tiny ones.
#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "flights.hpp"
#include "lib/trajectory.hpp"

namespace
{

using namespace pong;

Parameters serve_parameters(const pong_rig &rig, const Eigen::Vector3d &spin)
{
	const pong_ball_spec &ball = rig.ball;
	const sim::Ball serve = usual_serve();
	Parameters parameters;
	parameters << serve.position, serve.velocity, spin, ball.drag, ball.magnus, ball.restitution, ball.friction,
		ball.grip, 0.002, 0.02, -0.03;
	return parameters;
}

Motion motion_after(const pong_rig &rig, const Parameters &parameters, double time)
{
	const Physics physics(rig);
	Trajectory trajectory(physics, rig.table, parameters);
	while (trajectory.end().time < time)
		trajectory.advance(time);
	return trajectory.end();
}

// 0.7 s: after the bounce, which depends on everything. `spin` decides between rolling and sliding.
void expect_rates(const Eigen::Vector3d &spin)
{
	pong_rig rig;
	pong_rig_defaults(&rig);
	const Parameters parameters = serve_parameters(rig, spin);
	const Motion motion = motion_after(rig, parameters, 0.7);
	ASSERT_GT(motion.velocity.y(), -2); // it has bounced
	for (int i = 0; i < parameter_count; i++) {
		const double step = i == PONG_STATE_MAGNUS                        ? 1e-10
				    : i >= PONG_STATE_SPIN && i < PONG_STATE_DRAG ? 1e-3
										  : 1e-6;
		const Motion more = motion_after(rig, parameters + step * Parameters::Unit(i), 0.7);
		const Motion less = motion_after(rig, parameters - step * Parameters::Unit(i), 0.7);
		const Vector3 position = (more.position - less.position) / (2 * step);
		const Vector3 velocity = (more.velocity - less.velocity) / (2 * step);
		const Vector3 turn = (more.spin - less.spin) / (2 * step);
		EXPECT_LT((position - motion.position_rates.col(i)).norm(), 1e-3 * (position.norm() + 1e-2)) << i;
		EXPECT_LT((velocity - motion.velocity_rates.col(i)).norm(), 1e-3 * (velocity.norm() + 1e-2)) << i;
		EXPECT_LT((turn - motion.spin_rates.col(i)).norm(), 1e-3 * (turn.norm() + 1)) << i;
	}
}

TEST(Physics, RatesThroughARollingBounce)
{
	expect_rates({-200, 10, 20});
}

TEST(Physics, RatesThroughASlidingBounce)
{
	expect_rates({50, 40, -80});
}

// Where friction and spin leave open whether the ball will slide or roll, against many balls of which each does one.
TEST(Physics, ABounceThatMaySlideOrRollIsTheirMean)
{
	const pong_rig rig = rig_of_simulator();
	const Parameters parameters = serve_parameters(rig, {-130, 20, 0});
	Parameters sigma = Parameters::Zero();
	sigma.segment<3>(PONG_STATE_SPIN).setConstant(8);
	sigma[PONG_STATE_FRICTION] = 0.08;
	const ParameterMatrix covariance = sigma.cwiseAbs2().asDiagonal();
	const Physics physics(rig);
	Trajectory trajectory(physics, rig.table, parameters, &covariance);
	while (trajectory.end().time < 0.6)
		trajectory.advance(0.6);
	ParameterMatrix believed = covariance;
	believed.bottomRightCorner<2, 2>() += trajectory.scatter();
	const Rates &rates = trajectory.end().velocity_rates;
	const double expected = (rates * believed * rates.transpose()).topLeftCorner<3, 3>()(2, 2);

	std::mt19937 random(1);
	std::normal_distribution<double> normal;
	const int balls = 2000;
	double sum = 0, squares = 0;
	for (int i = 0; i < balls; i++) {
		const Parameters drawn =
			parameters + sigma.cwiseProduct(Parameters::NullaryExpr([&] { return normal(random); }));
		const double along = motion_after(rig, drawn, 0.6).velocity.z();
		sum += along / balls;
		squares += along * along / balls;
	}
	const double spread = std::sqrt(squares - sum * sum);
	EXPECT_GT(trajectory.scatter()(1, 1), 0); // it was open
	EXPECT_NEAR(trajectory.end().velocity.z(), sum, 0.1 * spread);
	EXPECT_NEAR(std::sqrt(expected), spread, 0.1 * spread);
	EXPECT_GT(std::abs(motion_after(rig, parameters, 0.6).velocity.z() - sum), 0.2 * spread); // either alone is off
}

TEST(Physics, LongStepsAreAsGoodAsTheSimulatorsTinyOnes)
{
	pong_rig rig = rig_of_simulator();
	for (const double scale : {0.0, 1.0, 8.0}) {
		sim::Ball ball = usual_serve();
		ball.spin *= scale;
		Parameters parameters = serve_parameters(rig, ball.spin);
		parameters.tail<3>().setZero();
		const sim::Flight flight = fly(ball);
		for (double time = 0.05; time < flight.hit()->time; time += 0.05) {
			const Vector3 position = motion_after(rig, parameters, time).position;
			EXPECT_LT((position - flight.at(time).position).norm(), 1e-4) << scale << " at " << time;
		}
	}
}

TEST(Physics, ABallPastTheEdgeDoesNotBounce)
{
	pong_rig rig = rig_of_simulator();
	Parameters parameters = serve_parameters(rig, {0, 0, 0});
	parameters[0] = 1.0;
	parameters.tail<3>().setZero();
	EXPECT_LT(motion_after(rig, parameters, 0.6).position.y(), 0);
}

} // namespace
