// What the cameras are told before they start: the section [capture] of rig.toml.
//
//     [capture]
//     exposure = 0.002    # s; without it: what the camera is set to
//     gain = 6.0          # dB; without it: what the camera is set to
//     trigger = "Line1"   # the input that fires the camera; "none": it runs by itself, at `rate`
//     rate = 110.0        # pictures a second; without it: learnt from the pictures
//     packet_size = 9000  # bytes; without it: the largest that comes through
#pragma once

#include <string>

namespace track
{

struct CaptureSettings {
	double exposure = 0;           // s; 0: not given
	bool has_gain = false;         // whether
	double gain = 0;               // dB, is given
	std::string trigger = "Line1"; // empty: no trigger
	double rate = 0;               // Hz; 0: not given
	int packet_size = 0;           // bytes; 0: not given
};

// Throws pong::Failure with file, line and column. A file without [capture] has the values above.
CaptureSettings load_capture_settings(const std::string &path);

} // namespace track
