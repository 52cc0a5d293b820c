// The command line of pongeye-track.
#pragma once

#include <string>

#include "pongeye.h"

namespace track
{

struct Arguments {
	std::string rig, images, replay, lcm_url, output, record;
	int profile = PONG_BEST;
	int record_what = 0;                          // RecordWhat
	double fps = 0, seconds = 0, record_last = 0; // 0: not given
	bool publish = false, live = false, list = false;
	bool profile_given = false;

	bool from_cameras() const
	{
		return images.empty() && replay.empty();
	}
};

// Returns false where --help or --version was all that was asked for. Throws pong::UsageError.
bool parse_arguments(int argc, char **argv, Arguments &arguments);

} // namespace track
