#include "presence.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "clock.hpp"

namespace track
{

namespace
{

// GigE Vision's control protocol: read one register, the control channel's privilege.
constexpr uint16_t PORT = 3956;
constexpr uint8_t QUESTION[] = {0x42, 0x01, 0x00, 0x80, 0x00, 0x04, 0x00, 0x01, 0x00, 0x00, 0x0a, 0x00};
constexpr uint8_t ANSWERED[] = {0x00, 0x81}; // bytes 2 and 3
constexpr size_t HEADER = 8, ANSWER = 12;
constexpr int ASK_AGAIN_MS = 30;

// Somebody who has exclusive control may refuse the question: then the status is not 0, and there is no value.
Presence understand(const uint8_t *answer, size_t size)
{
	if (size < HEADER || answer[2] != ANSWERED[0] || answer[3] != ANSWERED[1])
		return Presence::ABSENT;
	const bool refused = answer[0] || answer[1] || size < ANSWER;
	const bool held = refused || answer[8] || answer[9] || answer[10] || answer[11];
	return held ? Presence::CONTROLLED : Presence::FREE;
}

Presence ask_once(int descriptor, const sockaddr_in &camera)
{
	sendto(descriptor, QUESTION, sizeof QUESTION, 0, reinterpret_cast<const sockaddr *>(&camera), sizeof camera);
	pollfd input = {descriptor, POLLIN, 0};
	if (poll(&input, 1, ASK_AGAIN_MS) <= 0)
		return Presence::ABSENT;
	uint8_t answer[64];
	sockaddr_in from = {};
	socklen_t from_size = sizeof from;
	const ssize_t size =
		recvfrom(descriptor, answer, sizeof answer, 0, reinterpret_cast<sockaddr *>(&from), &from_size);
	const bool is_camera = size > 0 && from.sin_addr.s_addr == camera.sin_addr.s_addr;
	return is_camera ? understand(answer, static_cast<size_t>(size)) : Presence::ABSENT;
}

} // namespace

Presence ask_presence(uint32_t address, std::chrono::milliseconds patience)
{
	sockaddr_in camera = {};
	camera.sin_family = AF_INET;
	camera.sin_addr.s_addr = htonl(address);
	camera.sin_port = htons(PORT);
	const int descriptor = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
	const int64_t end_ns = monotonic_ns() + std::chrono::nanoseconds(patience).count();
	Presence presence;
	do
		presence = ask_once(descriptor, camera);
	while (presence == Presence::ABSENT && monotonic_ns() < end_ns);
	close(descriptor);
	return presence;
}

std::optional<uint32_t> parse_address(const std::string &text)
{
	in_addr address;
	if (inet_pton(AF_INET, text.c_str(), &address) != 1)
		return std::nullopt;
	return ntohl(address.s_addr);
}

} // namespace track
