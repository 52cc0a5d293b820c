// GVSP packets: a frame taken apart must be the same frame put together, whatever its size.
#include <gtest/gtest.h>

#include <numeric>

#include "gige/genicam.hpp"
#include "gige/stream.hpp"

using namespace gige;

namespace
{

Frame make_frame(uint32_t width, uint32_t height, size_t packet_size, uint16_t id = 7)
{
	Frame frame;
	frame.id = id;
	frame.timestamp = 0x0123456789abcdef;
	frame.region = {width, height, 8, 4};
	frame.packet_size = packet_size;
	frame.data.resize(static_cast<size_t>(width) * height);
	std::iota(frame.data.begin(), frame.data.end(), static_cast<uint8_t>(id));
	return frame;
}

Bytes packet(const Frame &frame, size_t index)
{
	Bytes datagram;
	make_packet(frame, index, Status::success, datagram);
	return datagram;
}

Bytes reassemble(const Frame &frame)
{
	Bytes data;
	for (size_t i = 1; i + 1 < packet_count(frame); i++) {
		const Bytes datagram = packet(frame, i);
		data.insert(data.end(), datagram.begin() + gvsp::header_size, datagram.end());
	}
	return data;
}

// The chunk's value, looked for from the end as a client does.
Bytes find_chunk(const Bytes &data, Chunk wanted)
{
	size_t end = data.size();
	while (end >= 8) {
		const uint32_t id = load32(&data[end - 8]), length = load32(&data[end - 4]);
		if (length + 8 > end)
			break;
		const auto begin = data.begin() + static_cast<ptrdiff_t>(end - 8 - length);
		if (id == static_cast<uint32_t>(wanted))
			return Bytes(begin, begin + length);
		end -= 8 + length;
	}
	return {};
}

} // namespace

TEST(GigeStream, FramesComeTogetherAgain)
{
	for (const size_t packet_size : {576, 1500, 9000})
		for (const uint32_t width : {16u, 136u, 640u}) {
			const Frame frame = make_frame(width, 40, packet_size);
			EXPECT_EQ(reassemble(frame), frame.data) << width << " px, packets of " << packet_size;
		}
}

TEST(GigeStream, DataThatFillsItsPacketsNeedsNoMore)
{
	// 540 = 576 - 28 - 8 bytes of data in each
	EXPECT_EQ(packet_count(make_frame(540, 2, 576)), 4u);
	EXPECT_EQ(packet_count(make_frame(541, 2, 576)), 5u);
}

TEST(GigeStream, PacketsAreNoLargerThanAllowedAndNumbered)
{
	const Frame frame = make_frame(640, 480, 1500);
	for (size_t i = 0; i < packet_count(frame); i++) {
		const Bytes datagram = packet(frame, i);
		EXPECT_LE(datagram.size() + gvsp::ip_udp_size, 1500u);
		EXPECT_EQ(load16(&datagram[0]), 0u);
		EXPECT_EQ(load16(&datagram[2]), frame.id);
		EXPECT_EQ(load32(&datagram[4]) & 0xffffff, i);
	}
}

TEST(GigeStream, LeaderAndTrailerTellThePicture)
{
	const Frame frame = make_frame(640, 480, 9000);
	const Bytes leader = packet(frame, 0), trailer = packet(frame, packet_count(frame) - 1);
	ASSERT_EQ(leader.size(), 44u);
	EXPECT_EQ(leader[4], gvsp::leader);
	EXPECT_EQ(load16(&leader[10]), gvsp::image_payload);
	EXPECT_EQ(load32(&leader[12]), 0x01234567u);
	EXPECT_EQ(load32(&leader[16]), 0x89abcdefu);
	EXPECT_EQ(load32(&leader[20]), gvsp::mono8);
	EXPECT_EQ(load32(&leader[24]), 640u);
	EXPECT_EQ(load32(&leader[28]), 480u);
	EXPECT_EQ(load32(&leader[32]), 8u);
	EXPECT_EQ(load32(&leader[36]), 4u);
	ASSERT_EQ(trailer.size(), 16u);
	EXPECT_EQ(trailer[4], gvsp::trailer);
	EXPECT_EQ(load32(&trailer[12]), 480u);
}

TEST(GigeStream, ChunksRideBehindThePixels)
{
	Frame frame = make_frame(64, 32, 1500, 300);
	const Bytes pixels = frame.data;
	frame.has_chunks = true;
	append_chunks(frame, {1234.5F, 1, 77});
	EXPECT_EQ(frame.data.size(), payload_size(frame.region, true));
	EXPECT_EQ(load16(&packet(frame, 0)[10]), gvsp::image_payload | gvsp::chunks_follow);
	EXPECT_EQ(find_chunk(frame.data, Chunk::image), pixels);
	EXPECT_EQ(load32(find_chunk(frame.data, Chunk::frame_id).data()), 300u);
	EXPECT_EQ(load32(find_chunk(frame.data, Chunk::timestamp).data() + 4), 0x89abcdefu);
	EXPECT_EQ(number_of(load32(find_chunk(frame.data, Chunk::exposure_time).data())), 1234.5F);
	EXPECT_EQ(load32(find_chunk(frame.data, Chunk::line_status).data()), 1u);
	EXPECT_EQ(load32(find_chunk(frame.data, Chunk::counter).data()), 77u);
}

TEST(GigeRing, ResendsTheRangeThatIsAskedFor)
{
	FrameRing ring;
	Frame frame = make_frame(640, 48, 1500);
	const Frame sent = frame;
	ring.add(frame);
	const std::vector<Bytes> packets = ring.resend(7, 3, 5);
	ASSERT_EQ(packets.size(), 3u);
	for (size_t i = 0; i < 3; i++) {
		Bytes expected;
		make_packet(sent, 3 + i, Status::packet_resent, expected);
		EXPECT_EQ(packets[i], expected);
	}
}

TEST(GigeRing, CutsARangeAtTheTrailer)
{
	FrameRing ring;
	Frame frame = make_frame(640, 48, 1500);
	const size_t count = packet_count(frame);
	ring.add(frame);
	EXPECT_EQ(ring.resend(7, 0, 0xffffff).size(), count);
	EXPECT_EQ(ring.resend(7, static_cast<uint32_t>(count) - 1, 0xffffffff).size(), 1u);
}

TEST(GigeRing, SaysWhatIsGone)
{
	FrameRing ring;
	Frame frame = make_frame(640, 48, 1500);
	const auto count = static_cast<uint32_t>(packet_count(frame));
	ring.add(frame);
	const uint32_t asked[][3] = {{8, 0, 1}, {0, 0, 1}, {7, 2, 1}, {7, count, count}};
	for (const auto &[id, first, last] : asked) {
		const std::vector<Bytes> packets = ring.resend(static_cast<uint16_t>(id), first, last);
		ASSERT_EQ(packets.size(), 1u);
		EXPECT_EQ(packets[0], make_unavailable(static_cast<uint16_t>(id), first));
		EXPECT_EQ(load16(packets[0].data()), 0x800c);
	}
}

TEST(GigeRing, ForgetsTheOldest)
{
	FrameRing ring;
	for (uint16_t id = 1; id <= 17; id++) {
		Frame frame = make_frame(64, 16, 1500, id);
		EXPECT_EQ(ring.add(frame).id, id);
	}
	EXPECT_EQ(load16(ring.resend(1, 0, 0)[0].data()), 0x800c);
	EXPECT_EQ(load16(ring.resend(2, 0, 0)[0].data()), 0x0100);
	ring.clear();
	EXPECT_EQ(load16(ring.resend(17, 0, 0)[0].data()), 0x800c);
}
