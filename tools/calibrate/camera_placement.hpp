// Where the cameras stand by a calibration: what a person sees at once to be wrong, corners cannot tell.
#pragma once

#include <string>

#include "pongeye.h"

namespace calibrate
{

// One sentence, in the rig's frame.
std::string describe_placement(const pong_camera camera[2]);

// Why the cameras cannot stand so; empty where they can. With a table they must look along it.
std::string misplaced(const pong_camera camera[2], bool table);

} // namespace calibrate
