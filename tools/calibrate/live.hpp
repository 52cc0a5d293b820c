// Pictures collected live, as the board is moved before the cameras.
#pragma once

#include <vector>

#include "arguments.hpp"
#include "pictures.hpp"

namespace calibrate
{

// Watches both cameras that arguments.cameras names; takes a pair when the board is still and stands as none did
// before, and says which poses are still wanted. Ends when there are enough, or on Ctrl-C. Throws pong::Failure.
std::vector<Pair> collect(const Arguments &arguments);

} // namespace calibrate
