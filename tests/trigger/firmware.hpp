// What the tests of the firmware share: a board, and a host that asks it and listens.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "board.hpp"
#include "trigger/protocol.h"

extern std::string firmware_file;

constexpr uint8_t OUT = 0x40, IN = 0xC0;

inline pong_trigger_settings settings_of(double rate, uint32_t width, uint32_t light = 0, uint32_t count = 0)
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
	Firmware() : board(firmware_file)
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
inline void expect_exact(const std::vector<uint64_t> &rises, const std::vector<uint64_t> &falls, double period,
			 uint32_t width)
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
