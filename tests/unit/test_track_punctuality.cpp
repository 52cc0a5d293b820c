// A clock that was set shows as pictures that come too late or too soon.
#include <gtest/gtest.h>

#include "punctuality.hpp"

namespace track
{

namespace
{

constexpr int64_t USUAL = 2300000, PERIOD = 9090909; // ns

Punctuality accustomed()
{
	Punctuality punctuality;
	for (int picture = 0; picture < 100; picture++)
		punctuality.learn(USUAL + picture % 7 * 20000);
	return punctuality;
}

TEST(TrackPunctuality, KnowsNothingBeforeTheFirstPicture)
{
	EXPECT_FALSE(Punctuality().doubts(USUAL));
}

TEST(TrackPunctuality, DoubtsAClockThatWasSetByOnePeriod)
{
	EXPECT_TRUE(accustomed().doubts(USUAL + PERIOD));
	EXPECT_TRUE(accustomed().doubts(USUAL - PERIOD));
	EXPECT_FALSE(accustomed().doubts(USUAL + 300000));
}

TEST(TrackPunctuality, IsNotMisledByABusyHost)
{
	Punctuality punctuality;
	punctuality.learn(USUAL + 5000000);
	EXPECT_TRUE(punctuality.doubts(USUAL));
	punctuality.learn(USUAL);
	EXPECT_FALSE(punctuality.doubts(USUAL + 100000));
	punctuality.learn(USUAL + 5000000);
	EXPECT_FALSE(punctuality.doubts(USUAL));
}

TEST(TrackPunctuality, GetsUsedToASlowerCamera)
{
	Punctuality punctuality = accustomed();
	for (int picture = 0; picture < 500; picture++)
		punctuality.learn(USUAL + PERIOD);
	EXPECT_FALSE(punctuality.doubts(USUAL + PERIOD));
}

} // namespace

} // namespace track
