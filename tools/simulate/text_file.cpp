#include "text_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "program.hpp"

namespace sim
{

void write_text(const std::string &path, const std::string &text)
{
	std::ofstream file(path);
	file << text << std::flush;
	if (!file)
		throw pong::Failure(path + ": cannot write: " + strerror(errno));
}

} // namespace sim
