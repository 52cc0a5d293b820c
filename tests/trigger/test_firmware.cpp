// The firmware's pulses, as it is flashed, in simavr: every edge by the cycle.
#include "firmware.hpp"

std::string firmware_file;

namespace
{

TEST_F(Firmware, TenSecondsAt110Hz)
{
	ASSERT_EQ(set(settings_of(110, 16'000, 40'000)), static_cast<int>(sizeof(pong_trigger_settings)));
	ASSERT_EQ(start(), 0);
	run_for(10.005);

	const double period = Board::FREQUENCY / 110;
	const std::vector<uint64_t> left = rises(LEFT);
	ASSERT_EQ(left.size(), 1101u);
	expect_exact(left, falls(LEFT), period, 16'000);
	EXPECT_EQ(rises(RIGHT), left);
	EXPECT_EQ(falls(RIGHT), falls(LEFT));
	EXPECT_EQ(rises(LIGHT), left);
	expect_exact(left, falls(LIGHT), period, 40'000);

	// What it says of its pulses: each, in order, with the tick of its edge.
	ASSERT_EQ(pulses.size(), left.size());
	for (size_t i = 0; i < pulses.size(); i++) {
		ASSERT_EQ(pulses[i].number, i + 1);
		ASSERT_EQ(pulses[i].tick - pulses[0].tick, left[i] - left[0]);
	}
	EXPECT_EQ(status().unreported, 0u);
}

TEST_F(Firmware, OddRates)
{
	for (const double rate : {7.3, 59.94, 119.88, 333.333, 500.0, 1234.5, 1999.99}) {
		const double period = Board::FREQUENCY / rate;
		const uint32_t width = static_cast<uint32_t>(period / 3), light = static_cast<uint32_t>(period * 0.9);
		ASSERT_GT(set(settings_of(rate, width, light)), 0) << rate;
		ASSERT_EQ(start(), 0);
		run_for(1.5);
		SCOPED_TRACE(rate);
		expect_exact(rises(LEFT), falls(LEFT), period, width);
		expect_exact(rises(LIGHT), falls(LIGHT), period, light);
		EXPECT_EQ(rises(LEFT), rises(RIGHT));
		EXPECT_EQ(falls(LEFT), falls(RIGHT));
		EXPECT_EQ(rises(LEFT), rises(LIGHT));
		ASSERT_EQ(stop(), 0);
	}
}

TEST_F(Firmware, TheNarrowestPulsesAndGaps)
{
	const uint32_t shortest = PONG_TRIGGER_MIN_TICKS, period = PONG_TRIGGER_MIN_PERIOD;
	const uint32_t widths[][2] = {{shortest, shortest},          {period - shortest, period - shortest},
				      {shortest, period - shortest}, {period - shortest, shortest},
				      {shortest + 200, shortest},    {shortest, shortest + 100}};
	for (const auto &[width, light] : widths) {
		SCOPED_TRACE(testing::Message() << width << " " << light);
		ASSERT_GT(set(settings_of(Board::FREQUENCY / period, width, light)), 0);
		ASSERT_EQ(start(), 0);
		run_for(1.5);
		expect_exact(rises(LEFT), falls(LEFT), period, width);
		expect_exact(rises(LIGHT), falls(LIGHT), period, light);
		ASSERT_EQ(stop(), 0);
	}
}

TEST_F(Firmware, SoManyPulsesAndNoMore)
{
	for (const uint32_t count : {1u, 2u, 55u}) {
		ASSERT_GT(set(settings_of(110, 1600, 80'000, count)), 0);
		ASSERT_EQ(start(), 0);
		EXPECT_EQ(status().state, PONG_TRIGGER_RUNNING);
		run_for(1);
		EXPECT_EQ(rises(LEFT).size(), count);
		EXPECT_EQ(falls(RIGHT).size(), count);
		EXPECT_EQ(falls(LIGHT).size(), count);
		EXPECT_EQ(status().state, PONG_TRIGGER_RESTING);
		EXPECT_EQ(status().pulses, count);
	}
}

TEST_F(Firmware, EveryStartCountsFromOne)
{
	ASSERT_GT(set(settings_of(200, 1600, 0, 3)), 0);
	for (int i = 0; i < 3; i++) {
		pulses.clear();
		ASSERT_EQ(start(), 0);
		run_for(0.05);
		ASSERT_EQ(pulses.size(), 3u);
		EXPECT_EQ(pulses[0].number, 1u);
		EXPECT_EQ(pulses[2].number, 3u);
	}
}

TEST_F(Firmware, ActiveLowRestsHigh)
{
	pong_trigger_settings settings = settings_of(110, 16'000, 16'000, 5);
	settings.active_low = 1;
	EXPECT_FALSE(board.level(LEFT));
	ASSERT_GT(set(settings), 0);
	EXPECT_TRUE(board.level(LEFT));
	EXPECT_TRUE(board.level(RIGHT));
	EXPECT_FALSE(board.level(LIGHT));
	ASSERT_EQ(start(), 0);
	run_for(0.1);
	ASSERT_EQ(falls(LEFT).size(), 5u);
	EXPECT_EQ(rises(LEFT)[0] - falls(LEFT)[0], 16'000u);
	EXPECT_EQ(falls(LEFT)[0], rises(LIGHT)[0]);
	EXPECT_TRUE(board.level(LEFT));
}

TEST_F(Firmware, StopEndsAPulseAtOnce)
{
	for (const uint8_t active_low : {0, 1}) {
		pong_trigger_settings settings = settings_of(10, 800'000, 800'000);
		settings.active_low = active_low;
		ASSERT_GT(set(settings), 0);
		ASSERT_EQ(start(), 0);
		board.run(200'000);
		ASSERT_EQ(board.level(LEFT), !active_low);
		ASSERT_TRUE(board.level(LIGHT));
		ASSERT_EQ(stop(), 0);
		EXPECT_EQ(board.level(LEFT), active_low == 1);
		EXPECT_EQ(board.level(RIGHT), active_low == 1);
		EXPECT_FALSE(board.level(LIGHT));
		board.forget_edges();
		board.run(4'000'000);
		EXPECT_TRUE(board.edges(LEFT).empty());
		EXPECT_EQ(status().state, PONG_TRIGGER_RESTING);
	}
}

TEST_F(Firmware, StartsOnAnOutsideEdge)
{
	for (int i = 0; i < 20; i++) {
		ASSERT_GT(set(settings_of(110, 1600, 1600, 2)), 0);
		ASSERT_EQ(start(PONG_TRIGGER_START_ON_EDGE), 0);
		EXPECT_EQ(status().state, PONG_TRIGGER_ARMED);
		board.run(1'000'000 + 4321 * i); // anywhere in the timer's wrap
		ASSERT_TRUE(board.edges(LEFT).empty());
		const uint64_t edge = board.cycle();
		board.drive_start_input(false);
		board.run(10'000);
		board.drive_start_input(true);
		run_for(0.03);
		ASSERT_EQ(rises(LEFT).size(), 2u);
		// Plus the cycle between a counter's match and its pin.
		EXPECT_EQ(rises(LEFT)[0] - edge, PONG_TRIGGER_LEAD + 1u);
		EXPECT_EQ(rises(LIGHT)[0], rises(LEFT)[0]);
	}
}

TEST_F(Firmware, AnOutsideEdgeNobodyWaitsForDoesNothing)
{
	ASSERT_GT(set(settings_of(110, 1600)), 0);
	board.drive_start_input(false);
	board.drive_start_input(true);
	EXPECT_EQ(start(PONG_TRIGGER_START_ON_EDGE), 0);
	board.run(1'000'000);
	EXPECT_EQ(status().state, PONG_TRIGGER_ARMED);
	EXPECT_EQ(stop(), 0);
	board.drive_start_input(false);
	board.run(1'000'000);
	EXPECT_EQ(status().state, PONG_TRIGGER_RESTING);
	EXPECT_TRUE(board.edges(LEFT).empty());
}

TEST_F(Firmware, StopsWhenItsHostIsSilentOrResetsTheBus)
{
	ASSERT_GT(set(settings_of(100, 1600)), 0);
	ASSERT_EQ(start(), 0);
	board.run(64'000'000);
	const size_t made = rises(LEFT).size();
	EXPECT_GE(made, 200u);
	EXPECT_LE(made, 201u);
	EXPECT_EQ(status().state, PONG_TRIGGER_RESTING);
	EXPECT_FALSE(board.level(LEFT));

	ASSERT_EQ(start(), 0);
	board.run(165'000);
	board.reset_bus();
	board.forget_edges();
	board.run(1'000'000);
	EXPECT_TRUE(board.edges(LEFT).empty());
	EXPECT_FALSE(board.level(LEFT));
	EXPECT_EQ(start(), Board::STALL) << "not configured";
}

} // namespace

int main(int argc, char **argv)
{
	testing::InitGoogleTest(&argc, argv);
	if (argc != 2) {
		fprintf(stderr, "usage: %s FIRMWARE\n", argv[0]);
		return 2;
	}
	firmware_file = argv[1];
	return RUN_ALL_TESTS();
}
