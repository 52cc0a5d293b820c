#include "gvcp.hpp"

#include <algorithm>

namespace gige
{

namespace
{

// Whether a command has as much data as its kind needs. Unknown commands are not judged by it.
bool has_right_size(uint16_t command, size_t size)
{
	switch (command) {
	case gvcp::discovery:
		return size == 0;
	case gvcp::packet_resend:
		return size == 12;
	case gvcp::read_register:
		return size >= 4 && size % 4 == 0;
	case gvcp::write_register:
		return size >= 8 && size % 8 == 0;
	case gvcp::read_memory:
		return size == 8;
	case gvcp::write_memory:
		return size > 4;
	default:
		return true;
	}
}

} // namespace

bool parse_request(const uint8_t *bytes, size_t size, Request *request)
{
	if (size < gvcp::header_size || bytes[0] != gvcp::key)
		return false;
	const size_t announced = load16(bytes + 4);
	request->command = load16(bytes + 2);
	request->id = load16(bytes + 6);
	request->data = bytes + gvcp::header_size;
	request->size = size - gvcp::header_size;
	request->wants_reply = (bytes[1] & gvcp::acknowledge_flag) || request->command == gvcp::discovery;
	request->status = Status::success;
	if (announced != request->size)
		request->status = Status::invalid_header;
	else if (request->size > gvcp::max_data || !has_right_size(request->command, request->size))
		request->status = Status::invalid_parameter;
	return true;
}

Bytes make_reply(const Request &request, Status status, const Bytes &data)
{
	Bytes reply;
	append16(reply, static_cast<uint16_t>(status));
	append16(reply, request.command + 1u);
	append16(reply, static_cast<uint32_t>(data.size()));
	append16(reply, request.id);
	reply.resize(gvcp::header_size + data.size());
	std::copy(data.begin(), data.end(), reply.begin() + gvcp::header_size);
	return reply;
}

} // namespace gige
