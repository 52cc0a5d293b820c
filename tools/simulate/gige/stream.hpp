// A picture as GVSP packets, and the last few pictures, kept for packets that a client asks for again.
#pragma once

#include <array>
#include <mutex>

#include "bytes.hpp"
#include "protocol.hpp"

namespace gige
{

struct Region {
	uint32_t width = 0, height = 0, x = 0, y = 0; // px
};

// What rides behind the pixels in chunk mode.
struct ChunkValues {
	float exposure_time;  // us
	uint32_t line_status; // bit 0: Line1 is high
	uint32_t counter;     // rising edges of Line1 so far
};

struct Frame {
	uint16_t id = 0;        // 1 .. 65535, then 1 again; 0: none
	uint64_t timestamp = 0; // of the exposure's start, ns of the camera's clock
	Region region;
	bool has_chunks = false;
	size_t packet_size = 0; // with IP and UDP headers
	Bytes data;             // pixels, and chunks
};

// The size of a picture's data.
size_t payload_size(const Region &region, bool has_chunks);

// Turn pixels, which frame.data holds already, into chunk data.
void append_chunks(Frame &frame, const ChunkValues &values);

// The packets of a frame: a leader, payload, a trailer.
size_t packet_count(const Frame &frame);

// Packet `index` < packet_count, as one datagram. Status success, or packet_resent.
void make_packet(const Frame &frame, size_t index, Status status, Bytes &datagram);

// What answers a request for packets that are gone.
Bytes make_unavailable(uint16_t frame_id, uint32_t packet_id);

// One writer, which may read what it wrote last without the lock; resend from any thread.
class FrameRing
{
public:
	// Keep a frame, in exchange for the storage of the oldest. It stays as it is until the next add or clear.
	const Frame &add(Frame &frame);

	void clear();

	// Packets first .. last of a frame; one packet that says so where it is gone or has no such packets.
	std::vector<Bytes> resend(uint16_t frame_id, uint32_t first, uint32_t last) const;

private:
	mutable std::mutex mutex_;
	std::array<Frame, 16> frames_;
	size_t oldest_ = 0;
};

} // namespace gige
