// Stereo pairs from a folder of pictures NAME-left.png and NAME-right.png, in name order.
//
// Where every NAME is a number, it is the pair's frame, and its time is frame / fps. Else the folder's times.txt says
// frame and utime: a table `# frame utime` with a row for every NAME, in their order.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "source.hpp"

namespace track
{

struct ImageFiles {
	std::string left, right; // paths; empty where there is none
	int64_t frame, utime;
};

// What the folder holds. fps <= 0: times.txt where there is one, else DEFAULT_FPS. Throws pong::Failure.
std::vector<ImageFiles> list_images(const std::string &folder, double fps);

constexpr double DEFAULT_FPS = 110;

// Reads the pairs one by one. A picture without the other side's is skipped and counted as unpaired. exposure: of all
// of them, s; 0: not known.
std::unique_ptr<Source> open_images(const std::string &folder, double fps, double exposure);

} // namespace track
