// A UDP socket on one address of this machine.
#pragma once

#include "bytes.hpp"
#include "protocol.hpp"

namespace gige
{

class UdpSocket
{
public:
	// Port 0: any. Throws pong::Failure with a sentence where the address or port is not to be had.
	explicit UdpSocket(const Endpoint &here);
	~UdpSocket();
	UdpSocket(const UdpSocket &) = delete;
	UdpSocket &operator=(const UdpSocket &) = delete;

	int descriptor() const
	{
		return descriptor_;
	}
	uint16_t port() const;

	// UDP promises nothing: what cannot be sent is lost. In one piece, or not at all.
	void send(const Endpoint &to, const Bytes &datagram) const;

	// Without waiting. False: nothing has come.
	bool receive(Bytes &datagram, Endpoint &from) const;

private:
	int descriptor_;
};

// "127.0.0.1" as a number; throws pong::Failure where the text is no IPv4 address.
uint32_t parse_address(const char *text);

} // namespace gige
