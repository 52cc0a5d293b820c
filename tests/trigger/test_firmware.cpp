// The firmware, as it is flashed, in simavr: its edges by the cycle, its USB by the byte.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "board.hpp"
#include "trigger/protocol.h"

namespace
{

std::string firmware = "build/firmware/pongeye-trigger.elf";

constexpr uint8_t OUT = 0x40, IN = 0xC0;

pong_trigger_settings settings_of(double rate, uint32_t width, uint32_t light = 0, uint32_t count = 0)
{
	const double period = PONG_TRIGGER_TICKS_PER_SECOND / rate;
	pong_trigger_settings settings = {};
	settings.period_ticks = static_cast<uint32_t>(period);
	settings.period_fraction = static_cast<uint32_t>((period - settings.period_ticks) * 4294967296.0);
	settings.width_ticks = width;
	settings.light_ticks = light;
	settings.count = count;
	return settings;
}

class Firmware : public testing::Test
{
protected:
	Firmware() : board(firmware)
	{
		board.enumerate();
	}

	int set(pong_trigger_settings settings, uint16_t version = PONG_TRIGGER_VERSION)
	{
		return board.control({OUT, PONG_TRIGGER_SETTINGS, version, 0, sizeof settings}, &settings);
	}

	int start(uint16_t how = PONG_TRIGGER_START_NOW)
	{
		board.forget_edges();
		return board.control({OUT, PONG_TRIGGER_START, how, 0, 0}, nullptr);
	}

	int stop()
	{
		return board.control({OUT, PONG_TRIGGER_STOP, 0, 0, 0}, nullptr);
	}

	pong_trigger_status status()
	{
		pong_trigger_status now = {};
		EXPECT_EQ(board.control({IN, PONG_TRIGGER_STATUS, 0, 0, sizeof now}, &now),
			  static_cast<int>(sizeof now));
		return now;
	}

	pong_trigger_info info()
	{
		pong_trigger_info labels = {};
		EXPECT_EQ(board.control({IN, PONG_TRIGGER_INFO, 0, 0, sizeof labels}, &labels),
			  static_cast<int>(sizeof labels));
		return labels;
	}

	int write_label(uint16_t which, std::string text)
	{
		return board.control({OUT, PONG_TRIGGER_LABEL, which, 0, static_cast<uint16_t>(text.size())},
				     text.data());
	}

	void read_pulses()
	{
		uint8_t packet[64];
		while (const int size = board.read_pulse_packet(packet)) {
			for (int i = 0; i < size; i += static_cast<int>(sizeof(pong_trigger_pulse))) {
				pong_trigger_pulse pulse;
				memcpy(&pulse, packet + i, sizeof pulse);
				pulses.push_back(pulse);
			}
			board.run(1600);
		}
	}

	// Listens every 5 ms and asks for the status twice a second, as a host does.
	void run_for(double seconds)
	{
		const uint64_t end = board.cycle() + static_cast<uint64_t>(seconds * Board::FREQUENCY);
		for (int i = 0; board.cycle() < end; i++) {
			board.run(80'000);
			read_pulses();
			if (i % 100 == 0)
				status();
		}
	}

	std::vector<uint64_t> rises(Output output) const
	{
		return times_of(output, true);
	}

	std::vector<uint64_t> falls(Output output) const
	{
		return times_of(output, false);
	}

	std::vector<uint64_t> times_of(Output output, bool level) const
	{
		std::vector<uint64_t> times;
		for (const Edge &edge : board.edges(output))
			if (edge.level == level)
				times.push_back(edge.cycle);
		return times;
	}

	Board board;
	std::vector<pong_trigger_pulse> pulses;
};

// Every pulse `width` long, every period the rate's to within a tick, and their mean to within a tick over all.
void expect_exact(const std::vector<uint64_t> &rises, const std::vector<uint64_t> &falls, double period, uint32_t width)
{
	ASSERT_GE(rises.size(), 2u);
	ASSERT_LE(rises.size() - falls.size(), 1u);
	for (size_t i = 0; i < falls.size(); i++)
		ASSERT_EQ(falls[i] - rises[i], width) << "pulse " << i + 1;
	for (size_t i = 1; i < rises.size(); i++)
		ASSERT_LT(std::abs(static_cast<double>(rises[i] - rises[i - 1]) - period), 1) << "pulse " << i + 1;
	const double whole = static_cast<double>(rises.back() - rises.front());
	EXPECT_LT(std::abs(whole - period * static_cast<double>(rises.size() - 1)), 1.001);
}

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

int main(int argc, char **argv)
{
	testing::InitGoogleTest(&argc, argv);
	if (argc > 1)
		firmware = argv[1];
	return RUN_ALL_TESTS();
}
