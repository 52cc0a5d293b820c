// What the cameras are told before they start: the section [capture] of rig.toml.
//
//     [capture]
//     exposure = 0.002    # s; without it: what the camera is set to
//     gain = 6.0          # dB; without it: what the camera is set to
//     trigger = "Line1"   # the input that fires the camera; "none": it runs by itself, at `rate`
//     edge = "rising"     # of the input, or "falling"
//     rate = 110.0        # pictures a second; without it: learnt from the pictures
//     offset = [0, 0]     # px: where on the sensor the picture begins, whose size is that of [left] and [right]
//     packet_size = 9000  # bytes; without it: the largest that comes through
//     counter = true      # have the camera count the trigger's pulses, where it can; without it: true
//     ptp = true          # have its clock follow the network's by PTP, where it can; without it: true
//     packet_delay = 0    # s between packets, where both cameras share a cable; without it: what the camera is set to
//
// Pixels are grey, of 8 bits (Mono8): nothing else can be tracked.
#pragma once

#include <string>

namespace track
{

struct CaptureSettings {
	double exposure = 0;           // s; 0: not given
	bool has_gain = false;         // whether
	double gain = 0;               // dB, is given
	std::string trigger = "Line1"; // empty: no trigger
	bool falling_edge = false;     // of the trigger, that begins the exposure
	double rate = 0;               // Hz; 0: not given
	int offset_x = 0, offset_y = 0;
	bool counter = true;      // of pulses, where the camera has one
	bool ptp = true;          // where the camera has it
	int packet_size = 0;      // bytes; 0: not given
	double packet_delay = -1; // s; below 0: not given
};

// Throws pong::Failure with file, line and column. A file without [capture] has the values above.
CaptureSettings load_capture_settings(const std::string &path);

} // namespace track
