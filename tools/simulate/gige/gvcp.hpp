// GVCP datagrams: commands taken apart with every length checked, replies put together.
#pragma once

#include "bytes.hpp"
#include "protocol.hpp"

namespace gige
{

struct Request {
	bool wants_reply;
	uint16_t command;
	uint16_t id;
	const uint8_t *data; // borrowed from the datagram
	size_t size;
	Status status; // success, or what is wrong with the datagram as such
};

// False: no GVCP command at all, which nobody answers.
bool parse_request(const uint8_t *bytes, size_t size, Request *request);

Bytes make_reply(const Request &request, Status status, const Bytes &data = {});

} // namespace gige
