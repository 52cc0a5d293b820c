// The firmware's USB: what it answers, what it refuses, and that nothing asked of it moves an edge.
#include <random>

#include "firmware.hpp"

namespace
{

TEST_F(Firmware, NamesItself)
{
	uint8_t device[18], text[64];
	ASSERT_EQ(board.control({0x80, 6, 0x0100, 0, sizeof device}, device), 18);
	EXPECT_EQ(device[8] | device[9] << 8, PONG_TRIGGER_USB_VENDOR);
	EXPECT_EQ(device[10] | device[11] << 8, PONG_TRIGGER_USB_PRODUCT);
	const std::string product = "Pongeye trigger";
	ASSERT_EQ(board.control({0x80, 6, 0x0302, 0x0409, sizeof text}, text),
		  static_cast<int>(2 + 2 * product.size()));
	for (size_t i = 0; i < product.size(); i++)
		EXPECT_EQ(text[2 + 2 * i], product[i]);
	EXPECT_EQ(info().version, PONG_TRIGGER_VERSION);
	EXPECT_STREQ(info().name, "pongeye");
	EXPECT_STREQ(info().serial, "1");
}

TEST_F(Firmware, RepliesAreCutToWhatTheHostAsksFor)
{
	uint8_t configuration[64];
	EXPECT_EQ(board.control({0x80, 6, 0x0200, 0, 9}, configuration), 9);
	EXPECT_EQ(configuration[2], 25);
	EXPECT_EQ(board.control({0x80, 6, 0x0200, 0, 64}, configuration), 25);
	EXPECT_EQ(board.control({0x80, 6, 0x0200, 0, 0}, configuration), 0);
}

TEST_F(Firmware, StallsOnWhatMakesNoSense)
{
	const pong_trigger_settings good = settings_of(110, 1600, 1600);
	std::vector<pong_trigger_settings> bad(8, good);
	bad[0].width_ticks = good.period_ticks;
	bad[1].width_ticks = PONG_TRIGGER_MIN_TICKS - 1;
	bad[2].light_ticks = good.period_ticks;
	bad[3].light_ticks = 1;
	bad[4].period_ticks = PONG_TRIGGER_MIN_PERIOD - 1;
	bad[5].period_ticks = PONG_TRIGGER_MAX_PERIOD + 1;
	bad[6].active_low = 2;
	bad[7].width_ticks = 0xffffffff;
	EXPECT_EQ(start(), Board::STALL) << "without settings";
	for (size_t i = 0; i < bad.size(); i++)
		EXPECT_EQ(set(bad[i]), Board::STALL) << i;
	EXPECT_EQ(set(good, PONG_TRIGGER_VERSION + 1), Board::STALL);
	EXPECT_EQ(start(), Board::STALL) << "still without settings";

	uint8_t data[64] = {};
	EXPECT_EQ(board.control({IN, 99, 0, 0, 4}, data), Board::STALL);
	EXPECT_EQ(board.control({OUT, 99, 0, 0, 0}, data), Board::STALL);
	EXPECT_EQ(board.control({OUT, PONG_TRIGGER_SETTINGS, PONG_TRIGGER_VERSION, 0, 5}, data), Board::STALL);
	EXPECT_EQ(board.control({0x80, 6, 0x0900, 0, 8}, data), Board::STALL);
	EXPECT_EQ(board.control({0x80, 6, 0x0309, 0, 8}, data), Board::STALL);
	EXPECT_EQ(board.control({0x00, 9, 2, 0, 0}, data), Board::STALL);
	EXPECT_EQ(board.control({0x20, 1, 0, 0, 0}, data), Board::STALL);

	ASSERT_GT(set(good), 0);
	EXPECT_EQ(start(7), Board::STALL);
	ASSERT_EQ(start(), 0);
	EXPECT_EQ(start(), Board::STALL) << "while running";
	EXPECT_EQ(set(good), Board::STALL) << "while running";
	EXPECT_EQ(status().state, PONG_TRIGGER_RUNNING);
}

TEST_F(Firmware, LabelsAreKept)
{
	EXPECT_EQ(write_label(PONG_TRIGGER_NAME, "table 2"), 7);
	EXPECT_EQ(write_label(PONG_TRIGGER_SERIAL, "0123456789abcdef"), 16);
	EXPECT_EQ(write_label(PONG_TRIGGER_SERIAL, "a\nb"), Board::STALL);
	EXPECT_EQ(write_label(2, "a"), Board::STALL);
	EXPECT_EQ(write_label(PONG_TRIGGER_NAME, "seventeen letters"), Board::STALL);
	board.enumerate();
	const pong_trigger_info labels = info();
	EXPECT_STREQ(labels.name, "table 2");
	EXPECT_EQ(std::string(labels.serial, 16), "0123456789abcdef");
	uint8_t text[64];
	ASSERT_EQ(board.control({0x80, 6, 0x0303, 0x0409, sizeof text}, text), 34);
	EXPECT_EQ(text[2 + 2 * 15], 'f');
}

TEST_F(Firmware, CountsThePulsesThatNobodyFetches)
{
	ASSERT_GT(set(settings_of(500, 1600, 0, 100)), 0);
	ASSERT_EQ(start(), 0);
	board.run(8'000'000);
	const uint32_t unreported = status().unreported;
	EXPECT_GT(unreported, 0u);
	read_pulses();
	EXPECT_EQ(pulses.size() + unreported, 100u);
	EXPECT_EQ(pulses.at(0).number, 1u);
}

ControlRequest random_request(std::mt19937 &random)
{
	static const uint8_t types[] = {0x00, 0x01, 0x02, 0x80, 0x81, 0x82, OUT, IN, 0x20, 0xA0};
	ControlRequest request = {};
	request.type = random() % 16 ? types[random() % sizeof types] : static_cast<uint8_t>(random());
	request.request = static_cast<uint8_t>(random() % 16 ? random() % 14 : random());
	request.value = static_cast<uint16_t>(random() % 4 ? random() % 5 : random());
	if (request.request == 6)
		request.value = static_cast<uint16_t>((random() % 5) << 8 | random() % 5);
	request.index = static_cast<uint16_t>(random() % 4 ? 0 : random());
	request.length = static_cast<uint16_t>(random() % 3 * (random() % 40));
	if (random() % 8 == 0)
		request = {IN, PONG_TRIGGER_STATUS, 0, 0, sizeof(pong_trigger_status)};
	return request;
}

// What is meant to end the pulses.
bool ends_pulses(const ControlRequest &request)
{
	return (request.type == OUT && request.request == PONG_TRIGGER_STOP) ||
	       ((request.type & 0xfc) == 0 && request.request == 9);
}

TEST_F(Firmware, NoRequestMovesAnEdge)
{
	std::mt19937 random(1);
	const uint32_t width = 16'000, light = 30'000;
	ASSERT_GT(set(settings_of(440, width, light)), 0);
	ASSERT_EQ(start(), 0);
	uint8_t data[4096];
	for (int i = 0; i < 100'000; i++) {
		const ControlRequest request = random_request(random);
		for (int k = 0; k < 48; k++)
			data[k] = static_cast<uint8_t>(random());
		if (!ends_pulses(request)) {
			ASSERT_NE(board.control(request, data), Board::TIMEOUT)
				<< "request " << i << ": type " << +request.type << " request " << +request.request;
		}
		if (i % 16 == 0)
			read_pulses();
	}
	EXPECT_EQ(status().state, PONG_TRIGGER_RUNNING);
	EXPECT_EQ(status().unreported, 0u);
	const std::vector<uint64_t> left = rises(LEFT);
	EXPECT_GT(left.size(), 1000u);
	expect_exact(left, falls(LEFT), Board::FREQUENCY / 440, width);
	EXPECT_EQ(rises(RIGHT), left);
	EXPECT_EQ(rises(LIGHT), left);
	expect_exact(left, falls(LIGHT), Board::FREQUENCY / 440, light);
}

// Everything at once: starts and stops, transfers given up half way, resets. In the end it must still do its work.
TEST_F(Firmware, NoSequenceOfRequestsHangsIt)
{
	std::mt19937 random(2);
	uint8_t data[4096];
	for (int i = 0; i < 20'000; i++) {
		ControlRequest request = random_request(random);
		pong_trigger_settings settings = settings_of(400 + random() % 1000, 800 + random() % 4000);
		memcpy(data, &settings, sizeof settings);
		if (random() % 4 == 0)
			request = {OUT, PONG_TRIGGER_SETTINGS, PONG_TRIGGER_VERSION, 0, sizeof settings};
		if (random() % 16 == 0)
			board.abandon(request);
		else if (board.control(request, data) == Board::TIMEOUT)
			FAIL() << "request " << i;
		if (random() % 512 == 0)
			board.enumerate();
	}
	board.enumerate();
	ASSERT_GT(set(settings_of(110, 1600, 0, 10)), 0);
	ASSERT_EQ(start(), 0);
	run_for(0.2);
	EXPECT_EQ(rises(LEFT).size(), 10u);
}

} // namespace
