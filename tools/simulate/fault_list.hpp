// The faults of --fault: "right:die@3+1,left:lose=0.001".
#pragma once

#include <array>
#include <string>
#include <vector>

#include "gige/faults.hpp"
#include "world.hpp"

namespace sim
{

// CAMERA:KIND[=AMOUNT][@BEGIN[+LENGTH]], several apart by commas. CAMERA is left, right or both. BEGIN is in seconds
// from the first pulse, or "flight2" or "bounce2": while the second ball flies towards the table, or bounces. Faults by
// camera. Throws pong::UsageError.
std::array<std::vector<gige::Fault>, 2> parse_faults(const std::string &list, const World &world);

} // namespace sim
