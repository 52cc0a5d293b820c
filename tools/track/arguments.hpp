// The command line of pongeye-track.
#pragma once

#include <string>

#include "pongeye.h"

namespace track
{

struct Arguments {
	std::string rig, images, lcm_url, output;
	int profile = PONG_BEST;
	double fps = 0, seconds = 0; // 0: not given
	bool publish = false, live = false, list = false;
};

// Returns false where --help or --version was all that was asked for. Throws pong::UsageError.
bool parse_arguments(int argc, char **argv, Arguments &arguments);

} // namespace track
