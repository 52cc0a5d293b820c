// Predictions from a known state: the hit is the simulator's, and no hit is promised where none can be known.
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <string>

#include "flights.hpp"

namespace
{

pong_state state_of(const sim::Ball &ball, const pong_rig &rig)
{
	pong_state state = {};
	state.utime = 1000000;
	std::copy_n(ball.position.data(), 3, state.position);
	std::copy_n(ball.velocity.data(), 3, state.velocity);
	std::copy_n(ball.spin.data(), 3, state.spin);
	state.has_spin = 1;
	const double coefficients[] = {rig.ball.drag,
				       rig.ball.magnus,
				       rig.ball.restitution,
				       rig.ball.friction,
				       rig.ball.grip,
				       rig.table.height,
				       0,
				       0};
	std::copy(std::begin(coefficients), std::end(coefficients), state.coefficients);
	return state;
}

pong_prediction predict(const sim::Ball &ball, const pong_rig &rig = rig_of_simulator())
{
	pong_settings settings;
	pong_settings_defaults(PONG_BEST, &settings);
	const pong_state state = state_of(ball, rig);
	pong_prediction prediction;
	EXPECT_EQ(pong_predict(&rig, &state, &settings, &prediction), PONG_FOUND);
	return prediction;
}

TEST(Predict, HitsWhereTheSimulatorHits)
{
	const sim::Flight flight = fly(usual_serve());
	const pong_prediction prediction = predict(usual_serve());
	ASSERT_TRUE(prediction.has_hit);
	EXPECT_NEAR(prediction.hit.position[0], flight.hit()->position.x(), 1e-4);
	EXPECT_NEAR(prediction.hit.position[1], flight.hit()->position.y(), 1e-4);
	EXPECT_NEAR(prediction.hit.position[2], 0, 1e-4);
	EXPECT_NEAR(static_cast<double>(prediction.hit.utime - 1000000) * 1e-6, flight.hit()->time, 1e-5);
}

TEST(Predict, BouncesWhereTheSimulatorBounces)
{
	const sim::Flight flight = fly(usual_serve());
	const pong_prediction prediction = predict(usual_serve());
	ASSERT_TRUE(prediction.has_bounce);
	EXPECT_NEAR(prediction.bounce.position[2], flight.bounces()[0].position.z(), 2e-4);
	EXPECT_NEAR(prediction.bounce.position[1], sim::ball_radius, 1e-5);
}

TEST(Predict, TheTopIsTheHighestPointAfterTheBounce)
{
	const pong_prediction prediction = predict(usual_serve());
	ASSERT_TRUE(prediction.has_top);
	EXPECT_NEAR(prediction.top.velocity[1], 0, 0.05);
	EXPECT_GT(prediction.top.utime, prediction.bounce.utime);
}

TEST(Predict, ThePathLeadsToTheHit)
{
	const pong_prediction prediction = predict(usual_serve());
	ASSERT_GT(prediction.path_count, 10);
	EXPECT_EQ(prediction.path[prediction.path_count - 1].utime, prediction.hit.utime);
	for (int i = 1; i < prediction.path_count; i++)
		EXPECT_GT(prediction.path[i].utime, prediction.path[i - 1].utime);
}

TEST(Predict, ABallIntoTheNetHasNoHit)
{
	sim::Ball ball = usual_serve();
	ball.velocity.y() = 0.4;
	EXPECT_FALSE(predict(ball).has_hit);
}

// Swept across the side line where it comes down: it bounces, touches the edge, flies past.
TEST(Predict, ABallOnTheEdgeHasNoHit)
{
	sim::Ball ball = usual_serve();
	ball.spin.setZero();
	std::string seen;
	for (double x = 1.0; x < 3; x += 0.01) {
		ball.velocity.x() = x;
		const pong_prediction prediction = predict(ball);
		const char now = !prediction.has_hit ? 'e' : prediction.has_bounce ? 'b' : 'p';
		if (seen.empty() || seen.back() != now)
			seen += now;
	}
	EXPECT_EQ(seen, "bep");
}

TEST(Predict, WithoutATableThereIsNoBounce)
{
	pong_rig rig = rig_of_simulator();
	rig.table.present = 0;
	EXPECT_FALSE(predict(usual_serve(), rig).has_bounce);
}

// The covariance of the hit, against what comes of states drawn from the covariance of the state.
TEST(Predict, TheHitsCovarianceIsThatOfDrawnStates)
{
	const pong_rig rig = rig_of_simulator();
	pong_settings settings;
	pong_settings_defaults(PONG_BEST, &settings);
	pong_state state = state_of(usual_serve(), rig);
	for (int i = 0; i < 9; i++)
		state.covariance[i][i] = i < 3 ? 1e-6 : i < 6 ? 4e-4 : 4;
	pong_prediction prediction;
	pong_predict(&rig, &state, &settings, &prediction);
	std::mt19937_64 random(5);
	std::normal_distribution<double> normal;
	double variance[4] = {};
	const int draws = 800;
	for (int draw = 0; draw < draws; draw++) {
		sim::Ball ball = usual_serve();
		for (int axis = 0; axis < 3; axis++) {
			ball.position[axis] += 1e-3 * normal(random);
			ball.velocity[axis] += 2e-2 * normal(random);
			ball.spin[axis] += 2 * normal(random);
		}
		const pong_prediction drawn = predict(ball);
		ASSERT_TRUE(drawn.has_hit);
		for (int axis = 0; axis < 2; axis++)
			variance[axis] += std::pow(drawn.hit.position[axis] - prediction.hit.position[axis], 2) / draws;
		variance[3] += std::pow(static_cast<double>(drawn.hit.utime - prediction.hit.utime) * 1e-6, 2) / draws;
	}
	for (const int i : {0, 1, 3})
		EXPECT_NEAR(variance[i] / prediction.hit_covariance[i][i], 1, 0.2) << i;
	EXPECT_EQ(prediction.hit_covariance[2][2], 0);
}

TEST(Predict, RefusesAStateThatIsNotFinite)
{
	const pong_rig rig = rig_of_simulator();
	for (const pong_profile profile : {PONG_PAPER, PONG_BEST}) {
		pong_settings settings;
		pong_settings_defaults(profile, &settings);
		pong_state state = state_of(usual_serve(), rig);
		state.velocity[1] = NAN;
		pong_prediction prediction;
		EXPECT_EQ(pong_predict(&rig, &state, &settings, &prediction), PONG_NONE);
	}
}

} // namespace
