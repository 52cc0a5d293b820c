// What a camera's registers hold when it is switched on.
#pragma once

#include <string>

#include "registers.hpp"

namespace gige
{

struct ControlSettings {
	uint32_t address; // the camera's own, IPv4
	std::string serial;
	int sensor_width, sensor_height; // px
	double exposure;                 // s
	int64_t power_on;                // when the camera's clock began, ns of CLOCK_MONOTONIC
	double drift = 0;                // of the camera's clock, parts in a million
};

// Who and what the camera is: the registers that never change.
void set_identity(RegisterFile &registers, const ControlSettings &settings);

// What a client may change.
void set_defaults(RegisterFile &registers, const ControlSettings &settings);

} // namespace gige
