#include "edge_socket.hpp"

#include <cerrno>
#include <cstring>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "program.hpp"

namespace gige
{

EdgeSocket::EdgeSocket(const std::string &path) : path_(path)
{
	sockaddr_un address = {};
	address.sun_family = AF_UNIX;
	if (path.size() >= sizeof address.sun_path)
		throw pong::Failure("trigger line " + path + ": the path is too long for a socket");
	memcpy(address.sun_path, path.c_str(), path.size());
	struct stat there;
	if (stat(path.c_str(), &there) == 0 && S_ISSOCK(there.st_mode))
		unlink(path.c_str());
	descriptor_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
	if (bind(descriptor_, reinterpret_cast<sockaddr *>(&address), sizeof address) == 0)
		return;
	const int error = errno;
	close(descriptor_);
	throw pong::Failure("trigger line " + path + ": cannot make this socket: " + strerror(error));
}

EdgeSocket::~EdgeSocket()
{
	close(descriptor_);
	unlink(path_.c_str());
}

std::optional<int64_t> EdgeSocket::receive() const
{
	int64_t time;
	char bytes[sizeof time + 1];
	ssize_t size;
	while ((size = recv(descriptor_, bytes, sizeof bytes, 0)) >= 0)
		if (size == sizeof time) {
			memcpy(&time, bytes, sizeof time);
			return time;
		}
	return std::nullopt;
}

} // namespace gige
