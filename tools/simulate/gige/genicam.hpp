// The GenICam description: the XML document in which a camera tells clients its features.
#pragma once

#include <string>
#include <vector>

#include "registers.hpp"

namespace gige
{

// Chunks: what a picture can carry behind its pixels.
enum class Chunk : uint32_t { image = 1, frame_id, timestamp, exposure_time, line_status, counter };

std::string describe(const std::vector<Register> &table);

} // namespace gige
