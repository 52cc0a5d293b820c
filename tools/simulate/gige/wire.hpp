// The way of the stream's packets from one camera to the host, on which some are lost and some overtaken.
#pragma once

#include <mutex>

#include "faults.hpp"
#include "udp_socket.hpp"

namespace gige
{

// For several threads at once.
class Wire
{
public:
	// Both are borrowed.
	Wire(const UdpSocket &socket, Faults &faults) : socket_(socket), faults_(faults)
	{
	}

	// A packet that leaves while this pulse is the last.
	void send(const Endpoint &to, const Bytes &packet, int64_t pulse);

private:
	const UdpSocket &socket_;
	Faults &faults_;
	std::mutex mutex_; // guards the rest
	Bytes overtaken_;  // waits for the next packet; empty: none
	Endpoint overtaken_to_;
};

} // namespace gige
