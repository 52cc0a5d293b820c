// What GigE Vision 1.2 says of the wire: GVCP, the control protocol, and GVSP, the stream protocol, both over UDP.
//
//   GVCP command: key 0x42, flags, command, size of what follows, request id      (1, 1, 2, 2, 2 bytes)
//   GVCP reply:   status, command + 1, size of what follows, the same request id  (2, 2, 2, 2 bytes)
//   GVSP packet:  status, block (frame) id, format, packet id                     (2, 2, 1, 3 bytes)
//
// A frame is a leader, payload packets, and a trailer, with packet ids from 0.
#pragma once

#include <cstddef>
#include <cstdint>

namespace gige
{

enum class Status : uint16_t {
	success = 0x0000,
	packet_resent = 0x0100,
	not_implemented = 0x8001,
	invalid_parameter = 0x8002,
	invalid_address = 0x8003,
	write_protect = 0x8004,
	bad_alignment = 0x8005,
	access_denied = 0x8006,
	busy = 0x8007,
	packet_unavailable = 0x800c,
	invalid_header = 0x800e,
};

namespace gvcp
{
constexpr uint16_t port = 3956;
constexpr size_t header_size = 8;
constexpr size_t max_data = 540; // after the header, so that any link carries it in one piece
constexpr uint8_t key = 0x42;
constexpr uint8_t acknowledge_flag = 0x01;

enum Command : uint16_t {
	discovery = 0x0002,
	packet_resend = 0x0040,
	read_register = 0x0080,
	write_register = 0x0082,
	read_memory = 0x0084,
	write_memory = 0x0086,
};
} // namespace gvcp

namespace gvsp
{
constexpr size_t header_size = 8;
constexpr size_t ip_udp_size = 28; // a "packet size" counts the IP and UDP headers too
constexpr size_t min_packet_size = 576, max_packet_size = 9000, packet_size_step = 4;
constexpr size_t max_datagram = max_packet_size - ip_udp_size;

enum Format : uint8_t { leader = 1, trailer = 2, payload = 3 };

constexpr uint16_t image_payload = 0x0001;
constexpr uint16_t chunks_follow = 0x4000; // a flag of the payload type
constexpr uint32_t mono8 = 0x01080001;
} // namespace gvsp

// One end of a UDP conversation, IPv4, host byte order.
struct Endpoint {
	uint32_t address = 0;
	uint16_t port = 0;

	bool operator==(const Endpoint &other) const
	{
		return address == other.address && port == other.port;
	}
};

} // namespace gige
