#include "stream.hpp"

#include <algorithm>
#include <utility>

#include "genicam.hpp"

namespace gige
{

namespace
{

constexpr size_t chunk_tag_size = 8; // id and length, behind the chunk
constexpr size_t chunk_data_size = 4 + 8 + 4 + 4 + 4;
constexpr size_t chunk_count = 6; // these five, and the image

void append_header(Bytes &datagram, Status status, uint16_t frame_id, gvsp::Format format, uint32_t packet_id)
{
	append16(datagram, static_cast<uint16_t>(status));
	append16(datagram, frame_id);
	append32(datagram, static_cast<uint32_t>(format) << 24 | (packet_id & 0xffffff));
}

uint16_t payload_type(const Frame &frame)
{
	return frame.has_chunks ? gvsp::image_payload | gvsp::chunks_follow : gvsp::image_payload;
}

void append_leader(Bytes &datagram, const Frame &frame)
{
	append16(datagram, 0);
	append16(datagram, payload_type(frame));
	append64(datagram, frame.timestamp);
	append32(datagram, gvsp::mono8);
	append32(datagram, frame.region.width);
	append32(datagram, frame.region.height);
	append32(datagram, frame.region.x);
	append32(datagram, frame.region.y);
	append32(datagram, 0); // no padding
}

void append_trailer(Bytes &datagram, const Frame &frame)
{
	append16(datagram, 0);
	append16(datagram, payload_type(frame));
	append32(datagram, frame.region.height);
}

size_t bytes_per_packet(const Frame &frame)
{
	return frame.packet_size - gvsp::ip_udp_size - gvsp::header_size;
}

void append_tag(Bytes &data, Chunk chunk, size_t length)
{
	append32(data, static_cast<uint32_t>(chunk));
	append32(data, static_cast<uint32_t>(length));
}

void append_chunk(Bytes &data, Chunk chunk, uint32_t value)
{
	append32(data, value);
	append_tag(data, chunk, 4);
}

} // namespace

size_t payload_size(const Region &region, bool has_chunks)
{
	const size_t pixels = static_cast<size_t>(region.width) * region.height;
	return has_chunks ? pixels + chunk_data_size + chunk_count * chunk_tag_size : pixels;
}

void append_chunks(Frame &frame, const ChunkValues &values)
{
	append_tag(frame.data, Chunk::image, frame.data.size());
	append_chunk(frame.data, Chunk::frame_id, frame.id);
	append64(frame.data, frame.timestamp);
	append_tag(frame.data, Chunk::timestamp, 8);
	append_chunk(frame.data, Chunk::exposure_time, bits_of(values.exposure_time));
	append_chunk(frame.data, Chunk::line_status, values.line_status);
	append_chunk(frame.data, Chunk::counter, values.counter);
}

size_t packet_count(const Frame &frame)
{
	return 2 + (frame.data.size() + bytes_per_packet(frame) - 1) / bytes_per_packet(frame);
}

void make_packet(const Frame &frame, size_t index, Status status, Bytes &datagram)
{
	datagram.clear();
	const auto packet_id = static_cast<uint32_t>(index);
	if (index == 0) {
		append_header(datagram, status, frame.id, gvsp::leader, packet_id);
		append_leader(datagram, frame);
	} else if (index + 1 == packet_count(frame)) {
		append_header(datagram, status, frame.id, gvsp::trailer, packet_id);
		append_trailer(datagram, frame);
	} else {
		append_header(datagram, status, frame.id, gvsp::payload, packet_id);
		const size_t begin = (index - 1) * bytes_per_packet(frame);
		const size_t size = std::min(bytes_per_packet(frame), frame.data.size() - begin);
		datagram.insert(datagram.end(), &frame.data[begin], &frame.data[begin] + size);
	}
}

Bytes make_unavailable(uint16_t frame_id, uint32_t packet_id)
{
	Bytes datagram;
	append_header(datagram, Status::packet_unavailable, frame_id, gvsp::payload, packet_id);
	return datagram;
}

const Frame &FrameRing::add(Frame &frame)
{
	const std::lock_guard<std::mutex> lock(mutex_);
	Frame &place = frames_[oldest_];
	oldest_ = (oldest_ + 1) % frames_.size();
	std::swap(place, frame);
	return place;
}

void FrameRing::clear()
{
	const std::lock_guard<std::mutex> lock(mutex_);
	for (Frame &frame : frames_)
		frame.id = 0;
}

std::vector<Bytes> FrameRing::resend(uint16_t frame_id, uint32_t first, uint32_t last) const
{
	const std::lock_guard<std::mutex> lock(mutex_);
	const auto frame = std::find_if(frames_.begin(), frames_.end(),
					[frame_id](const Frame &one) { return one.id == frame_id; });
	if (frame_id == 0 || frame == frames_.end() || first > last || first >= packet_count(*frame))
		return {make_unavailable(frame_id, first)};
	std::vector<Bytes> datagrams;
	const size_t end = std::min<size_t>(packet_count(*frame), size_t{last} + 1);
	for (size_t index = first; index < end; index++) {
		datagrams.emplace_back();
		make_packet(*frame, index, Status::packet_resent, datagrams.back());
	}
	return datagrams;
}

} // namespace gige
