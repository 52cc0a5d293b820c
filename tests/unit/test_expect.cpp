// What a flight makes expect of the next pair.
#include <gtest/gtest.h>

#include "expect.hpp"
#include "flights.hpp"
#include "owned.hpp"
#include "rigs.hpp"
#include "track.hpp"

namespace
{

pong_settings best_settings()
{
	pong_settings settings;
	pong_settings_defaults(PONG_BEST, &settings);
	return settings;
}

// A flight that is known to be at a place, by so much.
pong::FollowedFlight flight_at(double x, double y, double z, double sigma)
{
	pong::FollowedFlight flight = {};
	flight.points = 5;
	flight.expecting = true;
	flight.expected.has_spin = 1;
	const double place[3] = {x, y, z};
	std::copy_n(place, 3, flight.expected.position);
	for (int axis = 0; axis < 3; axis++)
		flight.expected.covariance[axis][axis] = sigma * sigma / (1 + axis);
	return flight;
}

// One that has a single point, so long ago.
pong::FollowedFlight flight_seen_once(double since_us)
{
	pong::FollowedFlight flight = {};
	flight.points = 1;
	flight.since_last = since_us;
	const double place[3] = {0.1, 0.3, 2};
	std::copy_n(place, 3, flight.last.position);
	return flight;
}

// A ball that is followed is where its points tell.
TEST(Expect, LooksAheadFromTheFlightsPoints)
{
	const pong_rig rig = rig_of_simulator();
	const pong_settings settings = best_settings();
	const pong::OwnedTrack track(pong_track_new(&rig, &settings, nullptr));
	const sim::Flight serve = fly(usual_serve());
	const std::vector<pong_point> points = points_of(serve, 0, 0.2, 110, 0.001);
	pong::FollowedFlight flight = {};
	pong::look_ahead(rig, *track, points[0].utime, settings, &flight);
	EXPECT_EQ(flight.points, 0);
	EXPECT_FALSE(flight.expecting || flight.firm);
	for (const pong_point &point : points)
		pong_track_push(track.get(), &point);
	flight.last = points.back();
	pong::look_ahead(rig, *track, points.back().utime + 9000, settings, &flight);
	EXPECT_EQ(flight.points, static_cast<int>(points.size()));
	EXPECT_TRUE(flight.expecting && flight.firm);
	EXPECT_EQ(flight.since_last, 9000);
	const double seconds = static_cast<double>(points.back().utime + 9000 - 1000000) * 1e-6;
	for (int axis = 0; axis < 3; axis++)
		EXPECT_NEAR(flight.expected.position[axis], serve.at(seconds).position[axis], 0.005);
}

// 6 cm, and 2.5 standard deviations along the axis that is known least.
TEST(Expect, ReachIsOfWhatIsNotKnown)
{
	pong::Expected expected;
	for (const double sigma : {0.0, 0.01, 0.1}) {
		ASSERT_TRUE(pong::has_reach(flight_at(0.1, 0.3, 2, sigma), &expected));
		EXPECT_NEAR(expected.reach, 0.06 + 2.5 * sigma, 1e-9);
		EXPECT_EQ(expected.state.position[2], 2);
	}
}

// It comes to the robot at 8 m/s, give or take 12.
TEST(Expect, OfABallSeenOnceTheReachIsThatOfAllBalls)
{
	pong::Expected expected;
	ASSERT_TRUE(pong::has_reach(flight_seen_once(10000), &expected));
	EXPECT_NEAR(expected.reach, 0.06 + 0.12, 1e-9);
	EXPECT_NEAR(expected.state.position[2], 2 - 0.08, 1e-9);
	EXPECT_EQ(expected.state.position[0], 0.1);
	EXPECT_FALSE(pong::has_reach({}, &expected));
}

// Windows lie around where each camera must see the ball, wider where that is less certain.
TEST(Expect, WindowsAreWhereTheBallIsSeen)
{
	const pong_rig rig = test_rig();
	const pong_settings settings = best_settings();
	pong::Expectation sure[2], unsure[2];
	pong::FollowedFlight flight = flight_at(0.1, 0.3, 2, 0.001);
	flight.expected.velocity[0] = 5;
	pong::expect(rig, settings, flight, false, sure);
	pong::expect(rig, settings, flight_at(0.1, 0.3, 2, 0.05), false, unsure);
	for (int side = 0; side < 2; side++) {
		ASSERT_TRUE(sure[side].windowed && unsure[side].windowed);
		double uv[2];
		pong_project(&rig.camera[side], flight.expected.position, uv);
		const pong_window &window = sure[side].window;
		EXPECT_NEAR(window.u + window.width / 2.0, uv[0], 1);
		EXPECT_NEAR(window.v + window.height / 2.0, uv[1], 1);
		const double size = pong_apparent_size(&rig.camera[side], flight.expected.position, rig.ball.diameter);
		EXPECT_GT(window.size_max, 1.1 * size);
		EXPECT_LT(window.size_min, size / 1.1);
		// Four standard deviations to either side.
		EXPECT_NEAR(unsure[side].window.width - window.width, 2 * 4 * 0.049 * size / rig.ball.diameter, 3);
	}
}

// How far it moves while the picture is exposed is only known of a ball that is followed.
TEST(Expect, TheStreakIsThatOfTheFlight)
{
	const pong_rig rig = test_rig();
	pong_settings settings = best_settings();
	pong::FollowedFlight flight = flight_at(0.1, 0.3, 2, 0.001);
	flight.expected.velocity[0] = 10;
	pong::Expectation there[2] = {};
	there[PONG_LEFT].exposure = 0.002;
	pong::expect(rig, settings, flight, false, there);
	ASSERT_TRUE(there[PONG_LEFT].streaked && !there[PONG_LEFT].seen_once);
	const double size = pong_apparent_size(&rig.camera[PONG_LEFT], flight.expected.position, 0.020);
	EXPECT_NEAR(there[PONG_LEFT].streak[0], -size, 0.1); // the robot's left is left in the picture
	pong::expect(rig, settings, flight_seen_once(9000), false, there);
	EXPECT_FALSE(there[PONG_LEFT].streaked);
	EXPECT_TRUE(there[PONG_LEFT].seen_once);
	EXPECT_EQ(there[PONG_LEFT].seconds, 0.009);
	EXPECT_EQ(there[PONG_LEFT].position[2], 2);
}

// Both or none: a ball out of one camera's sight is searched everywhere.
TEST(Expect, NoWindowWhereOneCameraDoesNotSeeTheBall)
{
	const pong_rig rig = test_rig();
	const pong_settings settings = best_settings();
	pong::Expectation there[2];
	pong::expect(rig, settings, flight_at(0.55, 0.3, 1.2, 0.001), false, there);
	pong_window window;
	const double place[3] = {0.55, 0.3, 1.2};
	ASSERT_NE(pong_window_around(&rig, PONG_LEFT, place, &settings, &window),
		  pong_window_around(&rig, PONG_RIGHT, place, &settings, &window));
	EXPECT_FALSE(there[PONG_LEFT].windowed || there[PONG_RIGHT].windowed);
}

// Amid people a ball that was seen once is searched as far from there as 20 m/s reach; else everywhere.
TEST(Expect, AWindowAroundTheFirstSightAmidPeople)
{
	const pong_rig rig = test_rig();
	const pong_settings settings = best_settings();
	const pong::FollowedFlight flight = flight_seen_once(5000);
	pong::Expectation there[2];
	pong::expect(rig, settings, flight, false, there);
	EXPECT_FALSE(there[PONG_LEFT].windowed || there[PONG_RIGHT].windowed);
	pong::expect(rig, settings, flight, true, there);
	for (int side = 0; side < 2; side++) {
		ASSERT_TRUE(there[side].windowed);
		pong_window least;
		pong_window_around(&rig, static_cast<pong_side>(side), flight.last.position, &settings, &least);
		const double px = pong_apparent_size(&rig.camera[side], flight.last.position, 0.1);
		EXPECT_NEAR(there[side].window.width - least.width, 2 * px, 2);
	}
}

} // namespace
