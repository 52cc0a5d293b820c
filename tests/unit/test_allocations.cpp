// Tracking and prediction ask for no memory, from a flight's first point to its last.
#include <algorithm>
#include <gtest/gtest.h>
#include <memory>
#include <vector>

#include "allocations.hpp"
#include "flights.hpp"
#include "owned.hpp"

namespace
{

class Allocations : public testing::TestWithParam<pong_profile>
{
};

INSTANTIATE_TEST_SUITE_P(Profiles, Allocations, testing::Values(PONG_PAPER, PONG_BEST),
			 [](const auto &profile) { return profile.param == PONG_PAPER ? "paper" : "best"; });

TEST(AllocationCount, SeesWhatIsAllocated)
{
	const long before = allocations();
	const std::vector<int> some(10);
	const std::unique_ptr<void, decltype(&free)> more(malloc(some.size()), free);
	EXPECT_GT(allocations(), before);
}

// Through a bounce, to the hit, and through the time after it in which the ball is lost; then a second flight.
TEST_P(Allocations, NoneInTracksAndPredictions)
{
	const pong_rig rig = rig_of_simulator();
	pong_settings settings;
	pong_settings_defaults(GetParam(), &settings);
	const pong::OwnedTrack owned(pong_track_new(&rig, &settings, nullptr));
	pong_track *const track = owned.get();
	const sim::Flight flight = fly(usual_serve());
	ASSERT_FALSE(flight.bounces().empty());
	ASSERT_GT(flight.bounces()[0].position.z(), flight.hit()->position.z()); // the bounce is on the way
	const double rate = 110;
	std::vector<pong_point> points = points_of(flight, 0, flight.hit()->time, rate, 0.002);
	int predicted = 0;
	int32_t flights = 0;
	const long before = allocations();
	for (int round = 0; round < 2; round++) {
		for (pong_point &point : points) {
			pong_state state, recent, then;
			pong_prediction prediction;
			pong_track_push(track, &point);
			flights = std::max(flights, pong_track_id(track));
			if (pong_track_state(track, &state) && pong_track_recent_state(track, &recent) &&
			    pong_predict_at(&rig, &recent, point.utime, &settings, &then))
				predicted += pong_predict(&rig, &state, &settings, &prediction);
			point.utime += 3000000; // for the next round
		}
		for (int miss = 1; miss < 50; miss++)
			pong_track_miss(track, points.back().utime - 3000000 + miss * 9091);
	}
	EXPECT_EQ(allocations(), before);
	EXPECT_EQ(flights, 2);
	EXPECT_GT(predicted, static_cast<int>(points.size()));
}

} // namespace
