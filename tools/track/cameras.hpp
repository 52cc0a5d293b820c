// Stereo pairs from the two cameras that rig.toml names.
#pragma once

#include <memory>

#include "capture_settings.hpp"
#include "pongeye.h"
#include "pulse_numbering.hpp"
#include "source.hpp"

namespace track
{

// Opens both cameras and starts them. The calling thread, which is to call next(), gets real-time priority where the
// user may have it. Frames are numbered by the pulses that `hear` takes; it may be empty. Throws pong::Failure.
std::unique_ptr<Source> open_cameras(const pong_rig &rig, const CaptureSettings &settings, HearPulse hear = {});

// Prints the cameras that answer as a table on stdout. Throws pong::Failure where there is none.
void list_cameras();

} // namespace track
