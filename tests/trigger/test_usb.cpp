// pongeye-trigger --usb as it is shipped, through the real libusb, against the real firmware: umockdev carries libusb's
// ioctls to a board in simavr. Both sides' clocks are emulated, so that every time can be checked to the microsecond.
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <sstream>
#include <unistd.h>

#include "board.hpp"
#include "child.hpp"
#include "emulated_clock.h"
#include "pongeye/trigger_t.hpp"
#include "trigger/protocol.h"
#include "usbfs.hpp"

namespace
{

std::string firmware, program, clock_library;

// The board's crystal runs slow by this much against the host's clock: more than two crystals differ.
constexpr double HOST_PER_BOARD = 1 + 150e-6;

class UsbPort : public testing::Test
{
protected:
	UsbPort() : board(firmware), testbed(umockdev_testbed_new())
	{
		if (!umockdev_in_mock_environment())
			throw std::runtime_error("run by umockdev-wrapper");
		char name[] = "/tmp/pongeye-test-XXXXXX";
		directory = mkdtemp(name);
		set_clock(0);
	}

	~UsbPort() override
	{
		g_object_unref(testbed);
		std::filesystem::remove_all(directory);
	}

	void plug_in()
	{
		usbfs = std::make_unique<Usbfs>(&board, testbed);
		begin = board.cycle();
		usbfs->on_time = [this] {
			set_clock(host_ns(board.cycle()));
			on_time();
		};
	}

	// Elapsed host time at a moment of the board's.
	int64_t host_ns(uint64_t cycle) const
	{
		return std::llround(static_cast<double>(cycle - begin) / Board::FREQUENCY * 1e9 * HOST_PER_BOARD);
	}

	double seconds() const
	{
		return static_cast<double>(board.cycle() - begin) / Board::FREQUENCY;
	}

	void set_clock(int64_t elapsed) const
	{
		std::fstream file(directory + "/clock", std::ios::binary | std::ios::out | std::ios::in);
		if (!file)
			file.open(directory + "/clock", std::ios::binary | std::ios::out);
		file.write(reinterpret_cast<const char *>(&elapsed), sizeof elapsed);
	}

	void start(const std::string &options)
	{
		std::vector<std::string> arguments = {program, "--lcm-url", "file://" + directory + "/log?mode=w"};
		std::istringstream words(options);
		for (std::string word; words >> word;)
			arguments.push_back(word);
		const char *preloaded = getenv("LD_PRELOAD");
		child = std::make_unique<Child>(
			arguments, std::vector<std::string>{"PONGEYE_TEST_CLOCK=" + directory + "/clock",
							    "LD_PRELOAD=" + std::string(preloaded ? preloaded : "") +
								    ":" + clock_library});
	}

	Outcome run(const std::string &options)
	{
		start(options);
		return child->finish();
	}

	std::vector<pongeye::trigger_t> messages() const
	{
		lcm::LogFile log(directory + "/log", "r");
		std::vector<pongeye::trigger_t> list;
		while (const lcm::LogEvent *event = log.readNextEvent()) {
			EXPECT_EQ(event->channel, "PONGEYE_TRIGGER");
			list.emplace_back();
			EXPECT_GT(list.back().decode(event->data, 0, event->datalen), 0);
		}
		return list;
	}

	std::vector<uint64_t> rises() const
	{
		std::vector<uint64_t> cycles;
		for (const Edge &edge : board.edges(LEFT))
			if (edge.level)
				cycles.push_back(edge.cycle);
		return cycles;
	}

	void expect_inactive() const
	{
		EXPECT_FALSE(board.level(LEFT));
		EXPECT_FALSE(board.level(RIGHT));
		EXPECT_FALSE(board.level(LIGHT));
	}

	Board board;
	UMockdevTestbed *testbed;
	std::string directory;
	std::unique_ptr<Usbfs> usbfs;
	std::unique_ptr<Child> child;
	uint64_t begin = 0;
	std::function<void()> on_time = [] {};
};

TEST_F(UsbPort, SoManyPulsesEachPublishedWithItsTime)
{
	plug_in();
	const Outcome outcome = run("--rate 110 --width 0.001 --exposure 0.002 --count 440 --usb");
	EXPECT_EQ(outcome.status, 0) << outcome.err;
	const std::vector<uint64_t> edges = rises();
	ASSERT_EQ(edges.size(), 440u);
	expect_inactive();

	const std::vector<pongeye::trigger_t> published = messages();
	ASSERT_EQ(published.size(), 440u) << "the fit has settled before the first";
	double worst = 0;
	for (size_t i = 0; i < published.size(); i++) {
		EXPECT_EQ(published[i].pulse, static_cast<int64_t>(i + 1));
		EXPECT_EQ(published[i].rate, 110);
		EXPECT_LT(published[i].residual, 50e-6);
		const int64_t truth = (EMULATED_EPOCH_NS + host_ns(edges[i])) / 1000;
		worst = std::max(worst, std::abs(static_cast<double>(published[i].utime - truth)));
	}
	// No more than half of a round trip, which takes 150 us here.
	EXPECT_LT(worst, 75) << outcome.err;

	// The table: pulses, and the rate by the host's clock.
	EXPECT_EQ(outcome.out.rfind("# utime pulses rate residual_us lateness_us late\n", 0), 0u);
	EXPECT_NE(outcome.out.find(" 109.98"), std::string::npos) << outcome.out;
	EXPECT_NE(outcome.err.find("440 pulses"), std::string::npos);
}

TEST_F(UsbPort, ActiveLowAndASerialNumber)
{
	plug_in();
	const Outcome outcome = run("--rate 200 --width 0.001 --count 5 --polarity low --usb 1");
	EXPECT_EQ(outcome.status, 0) << outcome.err;
	EXPECT_TRUE(board.level(LEFT));
	EXPECT_FALSE(board.level(LIGHT));
	EXPECT_EQ(messages().size(), 5u);
}

TEST_F(UsbPort, WaitsForTheOutsideEdge)
{
	plug_in();
	uint64_t edge = 0;
	on_time = [&] {
		if (!edge && seconds() > 2) {
			EXPECT_TRUE(rises().empty());
			edge = board.cycle();
			board.drive_start_input(false);
		}
	};
	const Outcome outcome = run("--rate 200 --width 0.001 --count 5 --start-on-edge --usb");
	EXPECT_EQ(outcome.status, 0) << outcome.err;
	ASSERT_EQ(rises().size(), 5u);
	EXPECT_EQ(rises()[0] - edge, PONG_TRIGGER_LEAD + 1u);
}

TEST_F(UsbPort, TermEndsItAndLeavesTheLinesInactive)
{
	plug_in();
	on_time = [&] {
		if (board.level(LEFT) && seconds() > 1)
			child->kill(SIGTERM);
	};
	const Outcome outcome = run("--rate 10 --width 0.09 --usb");
	EXPECT_EQ(outcome.status, 0) << outcome.err;
	expect_inactive();
	board.forget_edges();
	board.run(16'000'000);
	EXPECT_TRUE(rises().empty());
}

TEST_F(UsbPort, KilledItLeavesABoardThatStopsByItself)
{
	plug_in();
	on_time = [&] {
		if (board.level(LEFT) && seconds() > 1)
			child->kill(SIGKILL);
	};
	EXPECT_EQ(run("--rate 10 --width 0.09 --usb").status, -1);
	board.run(PONG_TRIGGER_SILENCE + 16'000);
	expect_inactive();
	board.forget_edges();
	board.run(16'000'000);
	EXPECT_TRUE(rises().empty());
}

TEST_F(UsbPort, UnpluggedIsAFailure)
{
	plug_in();
	on_time = [&] {
		if (seconds() > 1)
			usbfs->unplug();
	};
	const Outcome outcome = run("--rate 110 --width 0.001 --usb");
	EXPECT_EQ(outcome.status, 1);
	EXPECT_EQ(outcome.err, "pongeye-trigger: the trigger has been unplugged\n");
}

TEST_F(UsbPort, OtherProtocolsAreRefused)
{
	plug_in();
	usbfs->on_reply = [](const ControlRequest &request, uint8_t *data) {
		if (request.type == 0xC0 && request.request == PONG_TRIGGER_INFO)
			data[0] = PONG_TRIGGER_VERSION + 1;
	};
	const Outcome outcome = run("--rate 110 --width 0.001 --usb");
	EXPECT_EQ(outcome.status, 1);
	EXPECT_EQ(outcome.err, "pongeye-trigger: the trigger's firmware speaks version 2 of the protocol, this program "
			       "version 1: make flash\n");
	EXPECT_TRUE(rises().empty());
}

TEST_F(UsbPort, NoDeviceAndOtherSerials)
{
	Outcome outcome = run("--rate 110 --width 0.001 --usb");
	EXPECT_EQ(outcome.status, 1);
	EXPECT_EQ(outcome.err, "pongeye-trigger: no Pongeye trigger is plugged in\n");
	plug_in();
	outcome = run("--rate 110 --width 0.001 --usb 2");
	EXPECT_EQ(outcome.status, 1);
	EXPECT_EQ(outcome.err, "pongeye-trigger: no Pongeye trigger with the serial number '2' is plugged in\n");
}

TEST_F(UsbPort, RefusesWhatTheMicrocontrollerCannot)
{
	plug_in();
	Outcome outcome = run("--rate 2500 --width 0.0001 --usb");
	EXPECT_EQ(outcome.status, 2);
	EXPECT_EQ(outcome.err, "pongeye-trigger: the microcontroller makes 0.1 to 2000 pulses a second, not 2500 (see "
			       "--help)\n");
	outcome = run("--rate 110 --width 0.00001 --usb");
	EXPECT_EQ(outcome.status, 2);
	EXPECT_EQ(outcome.err, "pongeye-trigger: the microcontroller needs 5e-05 s between two edges (see --help)\n");
}

TEST_F(UsbPort, WritesNameAndSerialNumber)
{
	plug_in();
	EXPECT_EQ(run("--usb --write-name table-2 --write-serial 0042").status, 0);
	pong_trigger_info info = {};
	ASSERT_GT(board.control({0xC0, PONG_TRIGGER_INFO, 0, 0, sizeof info}, &info), 0);
	EXPECT_STREQ(info.name, "table-2");
	EXPECT_STREQ(info.serial, "0042");
}

} // namespace

int main(int argc, char **argv)
{
	testing::InitGoogleTest(&argc, argv);
	if (argc != 4) {
		fprintf(stderr, "usage: umockdev-wrapper %s FIRMWARE PROGRAM CLOCK-LIBRARY\n", argv[0]);
		return 2;
	}
	firmware = argv[1];
	program = argv[2];
	clock_library = argv[3];
	return RUN_ALL_TESTS();
}
