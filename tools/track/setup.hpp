// What a session tracks with: rig.toml, from a file or from a recording. Its text is read once, so that a recording
// holds what was tracked with.
#pragma once

#include <string>

#include "pongeye.h"

namespace track
{

struct RigText {
	std::string name; // of the file, for errors
	std::string text;
};

struct Setup {
	RigText rig_text;
	pong_rig rig;
	pong_profile profile;
	pong_settings settings; // the profile's, changed by what the rig sets
};

// They throw pong::Failure.
RigText read_rig_text(const std::string &path);
Setup make_setup(const RigText &text, pong_profile profile);

} // namespace track
