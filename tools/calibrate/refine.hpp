// Correct a rig after a knock, from the flights that it saw since.
#pragma once

#include "arguments.hpp"

namespace calibrate
{

// Returns the exit status. Throws pong::Failure.
int refine(const Arguments &arguments);

} // namespace calibrate
