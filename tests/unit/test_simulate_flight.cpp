#include <gtest/gtest.h>

#include <cmath>

#include "program.hpp"
#include "tools/simulate/flight.hpp"
#include "tools/simulate/room.hpp"
#include "tools/simulate/serve.hpp"

namespace
{

using Eigen::Vector3d;

// Gravity less buoyancy: rho V / m with rho = 1.2 kg/m^3 and a ball of 40 mm and 2.7 g.
const double g = 9.80665 * (1 - 1.2 * 4 / 3 * M_PI * 8e-6 / 0.0027);

sim::Coefficients vacuum()
{
	sim::Coefficients coefficients;
	coefficients.drag = coefficients.magnus = 0;
	return coefficients;
}

sim::Ball ball_with(const Vector3d &velocity, const Vector3d &spin)
{
	sim::Ball ball;
	ball.position = {0.1, 0.3, 3.5};
	ball.velocity = velocity;
	ball.spin = spin;
	return ball;
}

// About the contact point, which is r below the centre; I = 2/3 m r^2.
Vector3d angular_momentum(const sim::Ball &ball)
{
	const double r = 0.020, m = 0.0027;
	return Vector3d(0, r, 0).cross(m * ball.velocity) + 2.0 / 3 * m * r * r * ball.spin;
}

Vector3d slip(const sim::Ball &ball)
{
	Vector3d velocity = ball.velocity + ball.spin.cross(Vector3d(0, -0.020, 0));
	velocity.y() = 0;
	return velocity;
}

TEST(SimulateFlight, IsAParabolaWithoutAir)
{
	const Vector3d velocity(0.5, 2.0, -8);
	const sim::Flight flight(vacuum(), ball_with(velocity, Vector3d::Zero()), {});
	ASSERT_TRUE(flight.bounces().empty());
	for (const double t : {0.0, 0.0137, 0.1, 0.2501}) {
		const Vector3d expected = Vector3d(0.1, 0.3, 3.5) + t * velocity - Vector3d(0, g * t * t / 2, 0);
		EXPECT_LT((flight.at(t).position - expected).norm(), 1e-9);
		EXPECT_NEAR(flight.at(t).velocity.y(), 2.0 - g * t, 1e-9);
	}
	ASSERT_TRUE(flight.hit());
	EXPECT_NEAR(flight.hit()->time, 3.5 / 8, 1e-9);
	EXPECT_NEAR(flight.hit()->position.y(), 0.3 + 2 * 3.5 / 8 - g * std::pow(3.5 / 8, 2) / 2, 1e-9);
}

// k = C rho S / (2 m) = 0.1313 /m for C = 0.47.
TEST(SimulateFlight, DragSlowsDown)
{
	sim::Coefficients coefficients = vacuum();
	coefficients.drag = 0.47;
	const Vector3d a = sim::acceleration(coefficients, {0, 0, -10}, {0, 0, 0});
	EXPECT_NEAR(a.z(), 0.47 * 1.2 * M_PI * 4e-4 / (2 * 0.0027) * 100, 1e-9);
	EXPECT_NEAR(a.y(), -g, 1e-12);
}

// Towards the robot (-z) topspin turns about -x, and pulls down; a spin about +y pulls to -x.
TEST(SimulateFlight, SpinBendsTheWay)
{
	sim::Coefficients coefficients = vacuum();
	coefficients.magnus = 4.65e-6;
	const double pull = 4.65e-6 / 0.0027 * 100 * 10;
	EXPECT_NEAR(sim::acceleration(coefficients, {0, 0, -10}, {-100, 0, 0}).y(), -g - pull, 1e-9);
	EXPECT_NEAR(sim::acceleration(coefficients, {0, 0, -10}, {0, 100, 0}).x(), -pull, 1e-9);
}

TEST(SimulateFlight, BounceKeepsAngularMomentumAboutTheContact)
{
	for (const Vector3d &spin : {Vector3d(0, 0, 0), Vector3d(-300, 50, 20), Vector3d(250, -30, 90)}) {
		const sim::Ball before = ball_with({0.7, -3, -6}, spin), after = sim::bounce({}, before);
		const Vector3d change = angular_momentum(after) - angular_momentum(before);
		EXPECT_LT(change.norm(), 1e-12);
		EXPECT_NEAR(after.velocity.y(), 0.93 * 3, 1e-12);
	}
}

TEST(SimulateFlight, FastSlipSlides)
{
	const sim::Ball before = ball_with({0, -2, -9}, {0, 0, 0}), after = sim::bounce({}, before);
	EXPECT_NEAR(after.velocity.z(), -9 + 0.25 * 1.93 * 2, 1e-12);
	EXPECT_GT(slip(after).norm(), 1);
}

TEST(SimulateFlight, SlowSlipEndsRolling)
{
	const sim::Ball after = sim::bounce({}, ball_with({0.2, -4, -1}, {0, 0, 0}));
	EXPECT_LT(slip(after).norm(), 1e-12);
	EXPECT_NEAR(after.velocity.z(), -0.6, 1e-12);
}

TEST(SimulateFlight, TouchesTheTableExactly)
{
	const sim::Flight flight({}, ball_with({0, 0, -5}, {0, 0, 0}), {});
	ASSERT_GE(flight.bounces().size(), 1u);
	EXPECT_EQ(flight.bounces()[0].position.y(), 0.020);
	for (double t = 0; t < flight.hit().value().time; t += 0.0003)
		EXPECT_GT(flight.at(t).position.y(), 0.020 - 1e-9);
}

// Bounce after bounce the ball's time aloft shrinks, without an end of its own.
TEST(SimulateFlight, EndsWhereTheBallRolls)
{
	sim::Ball dropped = ball_with(Vector3d::Zero(), Vector3d::Zero());
	dropped.position = {0, 0.021, 1};
	const sim::Flight flight(vacuum(), dropped, {});
	EXPECT_GT(flight.bounces().size(), 2u);
	EXPECT_LT(flight.bounces().size(), 100u);
	EXPECT_LT(flight.duration(), 3);
}

TEST(SimulateServe, IsPlausibleAndItsOwn)
{
	const sim::FlightSettings settings;
	for (uint64_t seed = 0; seed < 15; seed++) {
		sim::Random random(seed), again(seed);
		const sim::Flight flight = sim::draw_flight(settings, {}, random);
		EXPECT_GT(flight.over_net(), 0.02);
		ASSERT_EQ(flight.bounces().size(), 1u);
		EXPECT_GE(flight.bounces()[0].position.z(), 0.4);
		EXPECT_LE(flight.bounces()[0].position.z(), 1.1);
		ASSERT_TRUE(flight.hit());
		EXPECT_GE(flight.hit()->position.y(), 0.03);
		EXPECT_LE(flight.hit()->position.y(), 0.9);
		EXPECT_NEAR(flight.hit()->position.z(), 0, 1e-9);
		EXPECT_LE(flight.at(0).spin.norm(), 5 * 2 * M_PI);
		EXPECT_EQ(sim::draw_flight(settings, {}, again).hit()->time, flight.hit()->time);
	}
}

TEST(SimulateServe, SaysWhenThereIsNone)
{
	sim::FlightSettings settings;
	settings.speed = {1, 1.1};
	sim::Random random(1);
	EXPECT_THROW(sim::draw_flight(settings, {}, random), pong::Failure);
}

} // namespace
