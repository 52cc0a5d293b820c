#include "setup.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "program.hpp"

namespace track
{

RigText read_rig_text(const std::string &path)
{
	errno = 0;
	std::ifstream file(path, std::ios::binary);
	std::ostringstream text;
	// A folder opens, and fails when it is read.
	if (!file || (file.peek() != EOF && !(text << file.rdbuf())) || errno)
		throw pong::Failure(path + ": " + strerror(errno));
	return {path, text.str()};
}

Setup make_setup(const RigText &text, pong_profile profile)
{
	Setup setup = {text, {}, profile, {}};
	pong_error error;
	pong_settings_defaults(profile, &setup.settings);
	if (pong_rig_parse(text.text.c_str(), text.name.c_str(), &setup.rig, &error) < 0 ||
	    pong_settings_parse(text.text.c_str(), text.name.c_str(), &setup.settings, &error) < 0)
		throw pong::Failure(error.text);
	return setup;
}

} // namespace track
