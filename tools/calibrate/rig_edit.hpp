// A rig.toml changed in place: what is not named here stays as people wrote it, comments too.
#pragma once

#include <string>

#include "pongeye.h"

namespace calibrate
{

// The text of a file. Throws pong::Failure.
std::string read_text(const std::string &path);

// `text`, a rig.toml that was read from `path`, with the P of one camera replaced. Throws pong::Failure.
std::string with_camera(const std::string &text, const std::string &path, pong_side side, const pong_camera &camera);

// `text` with the section `name` replaced by `section`, which begins with its header "[name]"; added at the end where
// it was not. Throws pong::Failure.
std::string with_section(const std::string &text, const std::string &path, const std::string &name,
			 const std::string &section);

} // namespace calibrate
