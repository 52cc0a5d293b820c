#include "udp_socket.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "program.hpp"

namespace gige
{

namespace
{

constexpr int send_buffer_size = 1 << 20;

sockaddr_in to_sockaddr(const Endpoint &end)
{
	sockaddr_in address = {};
	address.sin_family = AF_INET;
	address.sin_addr.s_addr = htonl(end.address);
	address.sin_port = htons(end.port);
	return address;
}

std::string describe_end(const Endpoint &end)
{
	char text[INET_ADDRSTRLEN] = "";
	const in_addr address = to_sockaddr(end).sin_addr;
	inet_ntop(AF_INET, &address, text, sizeof text);
	return pong::format("%s, port %u", text, end.port);
}

void set_option(int descriptor, int level, int option, int value)
{
	setsockopt(descriptor, level, option, &value, sizeof value);
}

} // namespace

UdpSocket::UdpSocket(const Endpoint &here) : descriptor_(socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0))
{
	if (descriptor_ < 0)
		throw pong::Failure(std::string("cannot open a UDP socket: ") + strerror(errno));
	set_option(descriptor_, SOL_SOCKET, SO_SNDBUF, send_buffer_size);
	set_option(descriptor_, IPPROTO_IP, IP_MTU_DISCOVER, IP_PMTUDISC_DO);
	const sockaddr_in address = to_sockaddr(here);
	if (bind(descriptor_, reinterpret_cast<const sockaddr *>(&address), sizeof address) < 0) {
		const int error = errno;
		close(descriptor_);
		throw pong::Failure("cannot open " + describe_end(here) + ": " + strerror(error) +
				    (error == EADDRINUSE ? " (is another simulator running?)" : ""));
	}
}

UdpSocket::~UdpSocket()
{
	close(descriptor_);
}

uint16_t UdpSocket::port() const
{
	sockaddr_in address = {};
	socklen_t size = sizeof address;
	getsockname(descriptor_, reinterpret_cast<sockaddr *>(&address), &size);
	return ntohs(address.sin_port);
}

void UdpSocket::send(const Endpoint &to, const Bytes &datagram) const
{
	const sockaddr_in address = to_sockaddr(to);
	sendto(descriptor_, datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr *>(&address),
	       sizeof address);
}

bool UdpSocket::receive(Bytes &datagram, Endpoint &from) const
{
	sockaddr_in address = {};
	socklen_t address_size = sizeof address;
	datagram.resize(65536); // more than any datagram has
	const ssize_t size = recvfrom(descriptor_, datagram.data(), datagram.size(), 0,
				      reinterpret_cast<sockaddr *>(&address), &address_size);
	if (size < 0)
		return false;
	datagram.resize(static_cast<size_t>(size));
	from = {ntohl(address.sin_addr.s_addr), ntohs(address.sin_port)};
	return true;
}

uint32_t parse_address(const char *text)
{
	in_addr address;
	if (inet_pton(AF_INET, text, &address) != 1)
		throw pong::Failure(std::string("'") + text + "' is no IPv4 address");
	return ntohl(address.s_addr);
}

} // namespace gige
