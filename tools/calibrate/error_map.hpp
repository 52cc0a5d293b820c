// The expected error over the volume, drawn as SVG.
#pragma once

#include <string>

#include "volume.hpp"

namespace calibrate
{

// Which of the table frame's axes run to the right and up; 0, 1, 2 for x, y, z.
struct MapAxes {
	size_t right, up;
};

// The mean over the places that lie behind each other, mm, as coloured and numbered cells with axes in metres.
std::string error_map(const Volume &volume, const MapAxes &axes, const std::string &title);

} // namespace calibrate
