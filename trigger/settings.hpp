// What the user wants of the pulses, whichever port makes them.
#pragma once

#include <cstdint>

namespace pong
{

struct Settings {
	double rate = 0;  // pulses a second
	double width = 0; // of a pulse, s
	double exposure =
		0;         // of the cameras, s; 0: as long as the pulse. The light, where a port has one, burns so long
	int64_t count = 0; // pulses, then stop; 0: until stopped
	bool active_low = false;
	bool start_on_edge = false; // wait for the outside edge first
};

double period_of(const Settings &settings);
double exposure_of(const Settings &settings);

// Throws UsageError where no port could do it.
void check_settings(const Settings &settings);

} // namespace pong
