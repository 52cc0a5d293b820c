// A calibration as a page that needs nothing else: pictures with corners and residuals, and where the volume is good.
#pragma once

#include <string>

#include "session.hpp"
#include "volume.hpp"

namespace calibrate
{

// Throws pong::Failure where the file cannot be written.
void write_report(const std::string &path, const Session &session, const Volume &volume,
		  const std::vector<Advice> &advice);

} // namespace calibrate
