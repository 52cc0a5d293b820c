// Pairing by time. A picture's buffer here is the number of the trigger pulse that exposed it, so that a wrong pair
// shows.
#include "pairing.hpp"

#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace
{

using track::Pairing;
using track::Picture;
using track::PicturePair;

constexpr int64_t BEGIN = 1700000000000000; // an utime
constexpr double RATE = 110, PERIOD = 1e6 / RATE;

int64_t pulse_utime(int pulse)
{
	return BEGIN + static_cast<int64_t>(PERIOD * pulse);
}

Picture picture_of(int pulse, int64_t jitter = 0)
{
	return {pulse_utime(pulse) + jitter, 0, reinterpret_cast<void *>(static_cast<intptr_t>(pulse))};
}

int pulse_of(const Picture &picture)
{
	return static_cast<int>(reinterpret_cast<intptr_t>(picture.buffer));
}

struct Rig {
	explicit Rig(double rate = RATE)
		: pairing(rate, [this](pong_side side, const Picture &picture) {
			  released[side].push_back(pulse_of(picture));
		  })
	{
	}

	void push(pong_side side, int pulse, int64_t jitter = 0)
	{
		pairing.push(side, picture_of(pulse, jitter));
		for (PicturePair pair; pairing.pop(pair);) {
			EXPECT_EQ(pulse_of(pair.picture[PONG_LEFT]), pulse_of(pair.picture[PONG_RIGHT]));
			pairs.push_back(pair);
		}
	}

	void push_both(int pulse)
	{
		push(PONG_LEFT, pulse);
		push(PONG_RIGHT, pulse);
	}

	std::vector<int> released[2];
	std::vector<PicturePair> pairs;
	Pairing pairing;
};

std::vector<int> pulses_of(const std::vector<PicturePair> &pairs)
{
	std::vector<int> pulses;
	for (const PicturePair &pair : pairs)
		pulses.push_back(pulse_of(pair.picture[PONG_LEFT]));
	return pulses;
}

TEST(TrackPairing, PairsWhatOnePulseExposed)
{
	Rig rig;
	for (int pulse = 0; pulse < 5; pulse++)
		rig.push_both(pulse);
	EXPECT_EQ(pulses_of(rig.pairs), (std::vector<int>{0, 1, 2, 3, 4}));
	EXPECT_EQ(rig.pairs[3].frame, 3);
	EXPECT_EQ(rig.pairs[3].utime, pulse_utime(3));
	EXPECT_EQ(rig.pairing.unpaired(), 0);
}

TEST(TrackPairing, TimeOfAPairIsTheMean)
{
	Rig rig;
	rig.push(PONG_LEFT, 0, -100);
	rig.push(PONG_RIGHT, 0, 300);
	ASSERT_EQ(rig.pairs.size(), 1u);
	EXPECT_EQ(rig.pairs[0].utime, pulse_utime(0) + 100);
}

TEST(TrackPairing, MissedPulseLeavesAGapAndReleasesThePartner)
{
	Rig rig;
	for (int pulse = 0; pulse < 10; pulse++) {
		if (pulse != 3)
			rig.push(PONG_LEFT, pulse);
		if (pulse != 6 && pulse != 7)
			rig.push(PONG_RIGHT, pulse);
	}
	EXPECT_EQ(pulses_of(rig.pairs), (std::vector<int>{0, 1, 2, 4, 5, 8, 9}));
	for (const PicturePair &pair : rig.pairs)
		EXPECT_EQ(pair.frame, pulse_of(pair.picture[PONG_LEFT]));
	EXPECT_EQ(rig.released[PONG_LEFT], (std::vector<int>{6, 7}));
	EXPECT_EQ(rig.released[PONG_RIGHT], (std::vector<int>{3}));
	EXPECT_EQ(rig.pairing.unpaired(), 3);
}

TEST(TrackPairing, LateStartOfOneCamera)
{
	Rig rig;
	for (int pulse = 0; pulse < 40; pulse++) {
		rig.push(PONG_LEFT, pulse);
		if (pulse >= 30)
			rig.push(PONG_RIGHT, pulse);
	}
	ASSERT_EQ(rig.pairs.size(), 10u);
	EXPECT_EQ(pulse_of(rig.pairs[0].picture[PONG_LEFT]), 30);
	EXPECT_EQ(rig.pairs[0].frame, 0);
	EXPECT_EQ(rig.pairing.unpaired(), 30);
}

TEST(TrackPairing, OneSideRunsAhead)
{
	Rig rig;
	for (int pulse = 0; pulse < 12; pulse++)
		rig.push(PONG_RIGHT, pulse);
	EXPECT_TRUE(rig.pairs.empty());
	for (int pulse = 0; pulse < 12; pulse++)
		rig.push(PONG_LEFT, pulse);
	EXPECT_EQ(rig.pairs.size(), 12u);
	EXPECT_EQ(rig.pairing.unpaired(), 0);
}

TEST(TrackPairing, OneSideNeverWaitsForEver)
{
	Rig rig;
	for (int pulse = 0; pulse < 100; pulse++)
		rig.push(PONG_LEFT, pulse);
	EXPECT_TRUE(rig.pairs.empty());
	EXPECT_GE(rig.released[PONG_LEFT].size(), 80u);
	EXPECT_EQ(rig.pairing.unpaired(), static_cast<int64_t>(rig.released[PONG_LEFT].size()));
	const size_t before = rig.released[PONG_LEFT].size();
	rig.pairing.clear();
	EXPECT_EQ(rig.released[PONG_LEFT].size(), 100u);
	EXPECT_LT(before, 100u);
}

TEST(TrackPairing, PictureOfThePastIsReleased)
{
	Rig rig;
	rig.push_both(5);
	rig.push_both(4);
	rig.push_both(5);
	rig.push_both(6);
	EXPECT_EQ(pulses_of(rig.pairs), (std::vector<int>{5, 6}));
	EXPECT_EQ(rig.pairing.unpaired(), 4);
}

TEST(TrackPairing, HalfAPeriodApartIsNoPair)
{
	Rig rig;
	const int64_t half = static_cast<int64_t>(PERIOD / 2);
	for (int pulse = 0; pulse < 20; pulse++) {
		rig.push(PONG_LEFT, pulse);
		rig.push(PONG_RIGHT, pulse, half + 1);
	}
	EXPECT_TRUE(rig.pairs.empty());
}

TEST(TrackPairing, LearnsTheRate)
{
	Rig rig(0);
	for (int pulse = 0; pulse < 50; pulse++)
		rig.push_both(pulse);
	EXPECT_GE(rig.pairs.size(), 44u);
	EXPECT_EQ(rig.pairing.unpaired(), 0);
	for (size_t i = 1; i < rig.pairs.size(); i++)
		EXPECT_EQ(rig.pairs[i].frame, rig.pairs[i - 1].frame + 1);
}

// Every second pulse missed by either camera, and never the same one: there is no pair, whatever rate was learnt.
TEST(TrackPairing, LearntRateIsNotFooledByAlternation)
{
	Rig rig(0);
	for (int pulse = 0; pulse < 100; pulse++)
		rig.push(pulse % 2 ? PONG_RIGHT : PONG_LEFT, pulse, pulse % 3 * 200);
	EXPECT_TRUE(rig.pairs.empty());
}

// A trigger whose rate is not quite what was said, for ten minutes: the count must not slip.
TEST(TrackPairing, CountFollowsATriggerThatDrifts)
{
	Rig rig(RATE * 1.001);
	for (int pulse = 0; pulse < 66000; pulse++)
		if (pulse % 500 > 5)
			rig.push_both(pulse);
	EXPECT_EQ(rig.pairs.back().frame - rig.pairs.front().frame,
		  pulse_of(rig.pairs.back().picture[PONG_LEFT]) - pulse_of(rig.pairs.front().picture[PONG_LEFT]));
}

// Jitter of 2 ms, one pulse in ten missed by either camera, the sides in any order: push() checks every pair.
TEST(TrackPairing, NeverAWrongPair)
{
	std::mt19937 random(1);
	std::uniform_int_distribution<int> percent(0, 99), jitter(-1000, 1000), ahead(0, 5);
	for (const double rate : {RATE, 0.0}) {
		Rig rig(rate);
		int next[2] = {0, 0};
		while (next[PONG_LEFT] < 2000 || next[PONG_RIGHT] < 2000) {
			const pong_side behind = next[PONG_LEFT] < next[PONG_RIGHT] ? PONG_LEFT : PONG_RIGHT;
			for (int count = ahead(random); count > 0; count--, next[behind]++)
				if (percent(random) >= 10)
					rig.push(behind, next[behind], jitter(random));
		}
		EXPECT_GT(rig.pairs.size(), 1500u);
		const int64_t first = rig.pairs[0].frame - pulse_of(rig.pairs[0].picture[PONG_LEFT]);
		for (const PicturePair &pair : rig.pairs)
			EXPECT_EQ(pair.frame - pulse_of(pair.picture[PONG_LEFT]), first);
	}
}

// Times that agree are not enough where the cameras' counters differ by another number of pulses than before. It is
// believed when it stands, for a camera that misses an edge lags behind for good.
TEST(TrackPairing, CountersMustAgree)
{
	Pairing pairing(RATE, [](pong_side, const Picture &) { ADD_FAILURE(); });
	std::vector<bool> miscounted;
	for (int pulse = 0; pulse < 12; pulse++) {
		Picture left = picture_of(pulse), right = picture_of(pulse);
		left.pulses = 100 + pulse;
		right.pulses = pulse + (pulse == 2 || pulse >= 6 ? 1 : 0);
		pairing.push(PONG_LEFT, left);
		pairing.push(PONG_RIGHT, right);
		PicturePair pair;
		ASSERT_TRUE(pairing.pop(pair));
		EXPECT_EQ(pair.frame, pair.miscounted ? 0 : pulse);
		miscounted.push_back(pair.miscounted);
	}
	EXPECT_EQ(miscounted,
		  std::vector<bool>({false, false, true, false, false, false, true, true, true, false, false, false}));
	EXPECT_EQ(pairing.miscounted(), 8);
}

} // namespace
