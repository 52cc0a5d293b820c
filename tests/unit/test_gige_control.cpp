// The control channel, datagram by datagram: no socket, no clock.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "gige/control.hpp"
#include "gige/genicam.hpp"

using namespace gige;

namespace
{

constexpr int64_t second = 1000000000;

Bytes command(uint16_t code, const std::vector<uint32_t> &words, uint16_t id = 42)
{
	Bytes datagram = {gvcp::key, gvcp::acknowledge_flag};
	append16(datagram, code);
	append16(datagram, static_cast<uint32_t>(words.size() * 4));
	append16(datagram, id);
	for (const uint32_t word : words)
		append32(datagram, word);
	return datagram;
}

Status status_of(const Bytes &reply)
{
	return reply.size() < 8 ? Status::packet_resent : static_cast<Status>(load16(reply.data()));
}

class GigeControl : public testing::Test
{
protected:
	Answer send(const Bytes &datagram)
	{
		return control.handle(datagram.data(), datagram.size(), client, now);
	}

	Status write(uint32_t address, uint32_t value)
	{
		return status_of(send(command(gvcp::write_register, {address, value})).reply);
	}

	Status write_real(uint32_t address, float value)
	{
		return write(address, bits_of(value));
	}

	uint32_t read(uint32_t address)
	{
		const Bytes reply = send(command(gvcp::read_register, {address})).reply;
		return reply.size() == 12 ? load32(&reply[8]) : 0xdeadbeef;
	}

	void take_control()
	{
		ASSERT_EQ(write(at::control_privilege, control_privilege), Status::success);
	}

	// Control, a stream destination, and AcquisitionStart.
	void stream()
	{
		take_control();
		write(at::stream_address, client.address);
		write(at::stream_port, 5000);
		ASSERT_EQ(write(at::acquisition_start, 1), Status::success);
	}

	FrameRing ring;
	Control control{{0x7f000001, "SIML", 640, 480, 0.002, 0}, ring};
	Endpoint client{0x7f000001, 1111}, other{0x7f000001, 2222};
	int64_t now = 100 * second;
};

} // namespace

TEST_F(GigeControl, IntroducesItself)
{
	const Bytes reply = send(command(gvcp::discovery, {}, 0x1234)).reply;
	ASSERT_EQ(reply.size(), 8u + 0xf8);
	EXPECT_EQ(status_of(reply), Status::success);
	EXPECT_EQ(load16(&reply[2]), 0x0003);
	EXPECT_EQ(load16(&reply[4]), 0xf8);
	EXPECT_EQ(load16(&reply[6]), 0x1234);
	EXPECT_EQ(load32(&reply[8 + 0x24]), 0x7f000001u);
	EXPECT_STREQ(reinterpret_cast<const char *>(&reply[8 + 0xd8]), "SIML");
	const Bytes question = command(gvcp::discovery, {}, 0x1234);
	EXPECT_EQ(control.discover(question.data(), question.size()), reply);
}

TEST_F(GigeControl, BroadcastsFindItAndDoNothingElse)
{
	const Bytes datagram = command(gvcp::read_register, {at::width});
	EXPECT_TRUE(control.discover(datagram.data(), datagram.size()).empty());
}

TEST_F(GigeControl, ReadsSeveralRegistersAtOnce)
{
	const Bytes reply = send(command(gvcp::read_register, {at::width, at::height})).reply;
	ASSERT_EQ(reply.size(), 16u);
	EXPECT_EQ(load32(&reply[8]), 640u);
	EXPECT_EQ(load32(&reply[12]), 480u);
}

TEST_F(GigeControl, ReadsMemoryUpToItsEnd)
{
	const Bytes url = send(command(gvcp::read_memory, {at::description_url, 64})).reply;
	ASSERT_EQ(url.size(), 8u + 4 + 64);
	unsigned address = 0, size = 0;
	ASSERT_EQ(sscanf(reinterpret_cast<const char *>(&url[12]), "Local:pongeye.xml;%x;%x", &address, &size), 2);
	EXPECT_EQ(address, 0x10000u);
	ASSERT_EQ(size % 4, 0u);
	const uint32_t end = address + size;
	EXPECT_EQ(status_of(send(command(gvcp::read_memory, {end - 8, 8})).reply), Status::success);
	EXPECT_EQ(status_of(send(command(gvcp::read_memory, {end - 4, 8})).reply), Status::invalid_address);
	EXPECT_EQ(status_of(send(command(gvcp::read_memory, {0xfffffffc, 8})).reply), Status::invalid_address);
	EXPECT_EQ(status_of(send(command(gvcp::read_register, {end})).reply), Status::invalid_address);
}

TEST_F(GigeControl, NamesWhatIsWrongWithARequest)
{
	take_control();
	const struct {
		Bytes datagram;
		Status status;
	} wrong[] = {
		{command(0x00f0, {}), Status::not_implemented},
		{command(gvcp::read_register, {}), Status::invalid_parameter},
		{command(gvcp::read_register, {at::width + 1}), Status::bad_alignment},
		{command(gvcp::read_memory, {at::width}), Status::invalid_parameter},
		{command(gvcp::read_memory, {at::width, 0}), Status::invalid_parameter},
		{command(gvcp::read_memory, {at::width, 540}), Status::invalid_parameter},
		{command(gvcp::read_memory, {at::width, 5}), Status::bad_alignment},
		{command(gvcp::read_memory, {at::width + 2, 4}), Status::bad_alignment},
		{command(gvcp::write_register, {at::width}), Status::invalid_parameter},
		{command(gvcp::write_register, {at::sensor_width, 10}), Status::write_protect},
		{command(gvcp::write_register, {0x9000, 10}), Status::write_protect},
		{command(gvcp::write_register, {0xfffffff0, 10}), Status::invalid_address},
		{command(gvcp::write_memory, {at::width}), Status::invalid_parameter},
		{command(gvcp::packet_resend, {1, 2}), Status::invalid_parameter},
		{command(gvcp::read_register, std::vector<uint32_t>(200)), Status::invalid_parameter},
	};
	for (const auto &[datagram, status] : wrong)
		EXPECT_EQ(status_of(send(datagram).reply), status) << testing::PrintToString(datagram);
}

TEST_F(GigeControl, NoticesTruncatedAndOverlongDatagrams)
{
	Bytes datagram = command(gvcp::read_register, {at::width, at::height});
	datagram.pop_back();
	EXPECT_EQ(status_of(send(datagram).reply), Status::invalid_header);
	datagram = command(gvcp::read_register, {at::width});
	datagram.push_back(0);
	EXPECT_EQ(status_of(send(datagram).reply), Status::invalid_header);
	for (size_t size = 0; size < 8; size++)
		EXPECT_TRUE(
			send(Bytes(datagram.begin(), datagram.begin() + static_cast<ptrdiff_t>(size))).reply.empty());
	datagram[0] = 0x41;
	EXPECT_TRUE(send(datagram).reply.empty());
}

TEST_F(GigeControl, KeepsSilentWhereNoReplyIsWanted)
{
	take_control();
	Bytes datagram = command(gvcp::write_register, {at::width, 320});
	datagram[1] = 0;
	EXPECT_TRUE(send(datagram).reply.empty());
	EXPECT_EQ(read(at::width), 320u);
}

TEST_F(GigeControl, WritesMemoryAsItWritesRegisters)
{
	take_control();
	const Bytes reply = send(command(gvcp::write_memory, {at::width, 320, 240})).reply;
	EXPECT_EQ(status_of(reply), Status::success);
	EXPECT_EQ(load32(&reply[8]), 8u);
	EXPECT_EQ(read(at::width), 320u);
	EXPECT_EQ(read(at::height), 240u);
	EXPECT_EQ(read(at::payload_size), 320u * 240);
}

TEST_F(GigeControl, SaysHowFarAWriteGot)
{
	take_control();
	const Bytes pairs = send(command(gvcp::write_register, {at::width, 320, at::height, 3, at::gain, 0})).reply;
	EXPECT_EQ(status_of(pairs), Status::invalid_parameter);
	EXPECT_EQ(load32(&pairs[8]), 1u);
	const Bytes memory = send(command(gvcp::write_memory, {at::height, 240, 0, 4, gvsp::mono8, 1})).reply;
	EXPECT_EQ(status_of(memory), Status::write_protect); // nothing is behind PixelFormat
	EXPECT_EQ(load32(&memory[8]), 16u);
}

TEST_F(GigeControl, RefusesValuesOutsideOfTheLimits)
{
	take_control();
	const uint32_t refused[][2] = {
		{at::width, 0},
		{at::width, 641},
		{at::width, 642},
		{at::width, 644},
		{at::width, 0xffffffff},
		{at::offset_x, 4},
		{at::offset_y, 4},
		{at::pixel_format, 1},
		{at::trigger_mode, 2},
		{at::gain, bits_of(25)},
		{at::gain, bits_of(NAN)},
		{at::exposure_time, bits_of(5)},
		{at::frame_rate, 0},
		{at::chunk_mode, 2},
		{at::stream_packet_size, 100},
		{at::stream_packet_size, 9001},
		{at::heartbeat_timeout, 10},
		{at::timestamp_control, 1},
		{at::control_privilege, 4},
		{at::stream_port, 0x10000},
		{at::exposure_time, bits_of(INFINITY)},
	};
	for (const auto &[address, value] : refused) {
		const uint32_t before = read(address);
		EXPECT_EQ(write(address, value), Status::invalid_parameter) << std::hex << address << " " << value;
		EXPECT_EQ(read(address), before);
	}
}

TEST_F(GigeControl, KeepsTheRegionOnTheSensor)
{
	take_control();
	EXPECT_EQ(write(at::width, 320), Status::success);
	EXPECT_EQ(write(at::offset_x, 320), Status::success);
	EXPECT_EQ(write(at::offset_x, 324), Status::invalid_parameter);
	EXPECT_EQ(write(at::width, 324), Status::invalid_parameter);
}

TEST_F(GigeControl, OnlyTheControllerWrites)
{
	EXPECT_EQ(write(at::width, 320), Status::access_denied);
	take_control();
	EXPECT_EQ(write(at::width, 320), Status::success);
	std::swap(client, other);
	EXPECT_EQ(write(at::width, 640), Status::access_denied);
	EXPECT_EQ(write(at::control_privilege, control_privilege), Status::access_denied);
	EXPECT_EQ(read(at::width), 320u);
	std::swap(client, other);
	EXPECT_EQ(write(at::control_privilege, 0), Status::success);
	std::swap(client, other);
	EXPECT_EQ(write(at::control_privilege, control_privilege), Status::success);
}

TEST_F(GigeControl, ExclusiveAccessKeepsReadersOut)
{
	EXPECT_EQ(write(at::control_privilege, exclusive_privilege), Status::success);
	std::swap(client, other);
	EXPECT_EQ(status_of(send(command(gvcp::read_register, {at::width})).reply), Status::access_denied);
	EXPECT_EQ(status_of(send(command(gvcp::read_memory, {at::width, 4})).reply), Status::access_denied);
	EXPECT_EQ(status_of(send(command(gvcp::discovery, {})).reply), Status::success);
}

TEST_F(GigeControl, ASilentClientLosesControl)
{
	stream();
	now += 2 * second;
	EXPECT_EQ(read(at::control_privilege), control_privilege); // any command is a heartbeat
	now += 2 * second;
	control.check_heartbeat(now);
	EXPECT_TRUE(control.is_controlled());
	now += 2 * second;
	control.check_heartbeat(now);
	EXPECT_FALSE(control.is_controlled());
	EXPECT_EQ(control.acquisition().session, 0u);
	EXPECT_EQ(read(at::control_privilege), 0u);
	EXPECT_EQ(read(at::stream_port), 0u);
}

TEST_F(GigeControl, OthersDontKeepAControllerAlive)
{
	take_control();
	std::swap(client, other);
	for (int i = 0; i < 4; i++) {
		now += second;
		read(at::width);
	}
	EXPECT_FALSE(control.is_controlled());
}

TEST_F(GigeControl, TellsTheSensorWhatTheClientWants)
{
	take_control();
	write(at::trigger_mode, 1);
	write(at::width, 320);
	write(at::offset_x, 64);
	write_real(at::exposure_time, 500);
	write_real(at::gain, 6);
	write(at::chunk_mode, 1);
	EXPECT_EQ(control.acquisition().session, 0u);
	write(at::acquisition_start, 1);
	const Acquisition wanted = control.acquisition();
	EXPECT_NE(wanted.session, 0u);
	EXPECT_TRUE(wanted.is_triggered);
	EXPECT_TRUE(wanted.by_line);
	EXPECT_TRUE(wanted.has_chunks);
	EXPECT_EQ(wanted.region.width, 320u);
	EXPECT_EQ(wanted.region.x, 64u);
	EXPECT_DOUBLE_EQ(wanted.exposure, 0.0005);
	EXPECT_DOUBLE_EQ(wanted.gain, 6);
	EXPECT_EQ(read(at::acquisition_start), 0u);
}

TEST_F(GigeControl, TheFormatIsLockedWhileStreaming)
{
	stream();
	EXPECT_EQ(write(at::width, 320), Status::busy);
	EXPECT_EQ(write(at::chunk_mode, 1), Status::busy);
	EXPECT_EQ(write_real(at::exposure_time, 700), Status::success);
	EXPECT_EQ(write(at::acquisition_stop, 1), Status::success);
	EXPECT_EQ(write(at::width, 320), Status::success);
}

TEST_F(GigeControl, EveryStartIsANewSession)
{
	stream();
	const uint64_t first = control.acquisition().session;
	write(at::acquisition_start, 1);
	EXPECT_EQ(control.acquisition().session, first);
	write(at::acquisition_stop, 1);
	write(at::acquisition_start, 1);
	EXPECT_NE(control.acquisition().session, first);
	control.finish(first);
	EXPECT_NE(control.acquisition().session, 0u);
	EXPECT_FALSE(control.wait_in_session(0, first));
}

TEST_F(GigeControl, SoftwareTriggersCountFromTheStart)
{
	stream();
	write(at::trigger_software, 1);
	write(at::trigger_software, 1);
	EXPECT_EQ(control.acquisition().software_triggers, 2u);
	write(at::acquisition_stop, 1);
	write(at::trigger_software, 1);
	write(at::acquisition_start, 1);
	EXPECT_EQ(control.acquisition().software_triggers, 0u);
}

TEST_F(GigeControl, LatchesItsClock)
{
	take_control();
	now = 123456789;
	EXPECT_EQ(write(at::timestamp_control, latch_timestamp), Status::success);
	const Bytes reply = send(command(gvcp::read_memory, {at::latched_timestamp, 8})).reply;
	EXPECT_EQ(load32(&reply[12]), 0u);
	EXPECT_EQ(load32(&reply[16]), 123456789u);
}

TEST_F(GigeControl, FiresATestPacketOfTheSizeAskedFor)
{
	take_control();
	write(at::stream_address, 0x7f000001);
	write(at::stream_port, 5000);
	const Answer answer =
		send(command(gvcp::write_register, {at::stream_packet_size, fire_test_packet_now | 8000}));
	ASSERT_EQ(answer.stream.size(), 1u);
	EXPECT_EQ(answer.stream[0].size(), 8000u - 28);
	EXPECT_EQ(answer.destination, (Endpoint{0x7f000001, 5000}));
	EXPECT_EQ(read(at::stream_packet_size), 8000u);
}

TEST_F(GigeControl, ResendsOnlyToTheHostThatStreams)
{
	stream();
	Frame frame;
	frame.id = 3;
	frame.region = {64, 64, 0, 0};
	frame.packet_size = 1500;
	frame.data.resize(64 * 64);
	ring.add(frame);
	const Bytes request = command(gvcp::packet_resend, {3, 1, 2});
	EXPECT_EQ(send(request).stream.size(), 2u);
	client.port = 9999;
	EXPECT_EQ(send(request).stream.size(), 2u);
	client.address = 0x7f000009;
	EXPECT_TRUE(send(request).stream.empty());
}

// Random bytes, random commands and damaged good ones: any answer is right that isn't a crash (see the sanitizers), is
// as large as it says, and leaves the registers sane.
TEST_F(GigeControl, SurvivesNoise)
{
	take_control();
	std::mt19937 random(1);
	const uint16_t codes[] = {0x02, 0x40, 0x80, 0x82, 0x84, 0x86, 0x1234};
	for (int i = 0; i < 50000; i++) {
		if (!control.is_controlled())
			take_control();
		std::vector<uint32_t> words(random() % 8);
		for (uint32_t &word : words)
			word = random() % 2 ? at::width + 4 * (random() % 100) : random();
		Bytes datagram = command(codes[random() % 7], words);
		if (random() % 2)
			datagram[random() % datagram.size()] = static_cast<uint8_t>(random());
		if (random() % 4 == 0)
			datagram.resize(random() % 600);
		const Bytes reply = send(datagram).reply;
		if (!reply.empty()) {
			ASSERT_GE(reply.size(), 8u);
			ASSERT_EQ(load16(&reply[4]), reply.size() - 8);
		}
	}
	const Region region = control.acquisition().region;
	EXPECT_LE(region.x + region.width, 640u);
	EXPECT_LE(region.y + region.height, 480u);
}

TEST(GigeDescription, TellsEveryFeatureWithItsAddress)
{
	const std::vector<Register> table = register_table(640, 480);
	const std::string text = describe(table);
	for (const Register &place : table) {
		if (!*place.category)
			continue;
		char address[32];
		snprintf(address, sizeof address, "<Address>0x%x</Address>", place.address);
		EXPECT_NE(text.find("Name=\"" + std::string(place.name) + "\""), std::string::npos) << place.name;
		EXPECT_NE(text.find(address), std::string::npos) << place.name;
	}
}

TEST(GigeDescription, RegistersDontOverlap)
{
	const std::vector<Register> table = register_table(640, 480);
	for (const Register &one : table)
		for (const Register &two : table)
			EXPECT_TRUE(&one == &two || one.address + one.length <= two.address ||
				    two.address + two.length <= one.address)
				<< one.name << " " << two.name;
}
