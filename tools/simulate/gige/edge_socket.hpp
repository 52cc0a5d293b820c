// The end of a wire that comes from outside: a Unix datagram socket at a path. A datagram is a rising edge, 8 bytes:
// its time, ns of CLOCK_MONOTONIC, an int64_t as this machine has it. So an edge keeps its time, however late it is
// heard of.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace gige
{

class EdgeSocket
{
public:
	// Makes the socket; a socket that is left over from before is replaced. Throws pong::Failure.
	explicit EdgeSocket(const std::string &path);
	~EdgeSocket();
	EdgeSocket(const EdgeSocket &) = delete;
	EdgeSocket &operator=(const EdgeSocket &) = delete;

	int descriptor() const
	{
		return descriptor_;
	}

	// The time of the next edge; none has come. What is not 8 bytes long is no edge.
	std::optional<int64_t> receive() const;

private:
	std::string path_;
	int descriptor_;
};

} // namespace gige
