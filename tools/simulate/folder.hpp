// Pictures, rig and truth into a folder, as pongeye-track --images reads them.
#pragma once

#include <string>

#include "world.hpp"

namespace sim
{

struct FolderSettings {
	std::string path;
	double rate;    // frames/s
	int64_t frames; // how many
};

// Writes NAME-left.png and NAME-right.png, NAME the frame's number from 000000 on, rig.toml, truth.txt, and boards.txt
// where the scene has boards. Returns the number of frames written: fewer where Ctrl-C came. Throws pong::Failure where
// it cannot.
int64_t write_folder(const FolderSettings &settings, const Scene &scene, uint64_t seed);

} // namespace sim
