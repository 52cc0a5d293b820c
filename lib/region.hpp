// The search region as the detector reads it.
#pragma once

#include <vector>

#include "pongeye.h"

struct pong_region {
	int width, height;
	std::vector<pong_region_row> rows;
};
