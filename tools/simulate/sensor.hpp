// The sensor: from light to the grey levels of an 8-bit industrial camera, with shot and read noise.
#pragma once

#include <cstdint>
#include <vector>

namespace sim
{

struct SensorSettings {
	bool noise = true;
	double full_well = 20000; // electrons at grey level 255
	double read_noise = 16;   // electrons rms
};

// Light in 1/64 grey levels, and the noise's standard deviation on it in 1/1024 grey levels: what the fast loop needs.
using Fixed = int16_t;

class Sensor
{
public:
	Sensor(const SensorSettings &settings, uint64_t seed);

	// Light from grey levels, and back.
	static Fixed light(double level);
	static double level(Fixed light);
	Fixed deviation(Fixed light) const;

	// Expose one row. `key` tells rows and pictures apart: the same key gives the same noise.
	void expose(const Fixed *light, const Fixed *deviation, int width, uint64_t key, uint8_t *pixels) const;

private:
	std::vector<Fixed> deviations_; // by light
	std::vector<Fixed> normal_;     // standard normal deviates in 1/4096
};

} // namespace sim
