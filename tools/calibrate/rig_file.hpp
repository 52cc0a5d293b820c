// rig.toml as calibration writes it.
#pragma once

#include <string>

#include "session.hpp"
#include "volume.hpp"

namespace calibrate
{

// The rig of these cameras, with the usual ball, and the usual table if there is one.
pong_rig make_rig(const pong_camera camera[2], bool table);

// Write the rig, and how it was calibrated as a section [calibration]. "-" is stdout. Throws pong::Failure.
void write_rig(const std::string &path, const pong_rig &rig, const std::string &calibration);

// "-" is stdout. Throws pong::Failure.
void write_text(const std::string &path, const std::string &text);

// The section [calibration]: date, method, residuals, expected error, covariance.
std::string describe_calibration(const Session &session, const Volume &volume, pong_profile profile);

// The date of now, as TOML has it.
std::string today();

} // namespace calibrate
