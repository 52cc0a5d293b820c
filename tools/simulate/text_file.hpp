// Whole texts into files.
#pragma once

#include <string>

namespace sim
{

// Throws pong::Failure where it cannot.
void write_text(const std::string &path, const std::string &text);

} // namespace sim
