// Stereo pairs from the two cameras that rig.toml names.
#pragma once

#include <memory>

#include "capture_settings.hpp"
#include "onlooker.hpp"
#include "pongeye.h"
#include "pulse_numbering.hpp"
#include "source.hpp"

namespace track
{

constexpr int TRACKING_PRIORITY = 9; // below the threads that receive the pictures

// Opens both cameras and starts them, each as soon as it is there, and again whenever it was lost. The calling thread,
// which is to call next(), gets real-time priority where the user may have it. Frames are numbered by the pulses that
// `hear` takes; it may be empty. The onlooker, which may be null, is shown every picture when it comes. Throws
// pong::Failure; so does next() where a camera cannot do what `settings` ask for.
std::unique_ptr<Source> open_cameras(const pong_rig &rig, const CaptureSettings &settings, HearPulse hear = {},
				     Onlooker *onlooker = nullptr);

// Prints the cameras that answer, and what they are set to, as a table on stdout. Throws pong::Failure where there is
// none.
void list_cameras();

} // namespace track
