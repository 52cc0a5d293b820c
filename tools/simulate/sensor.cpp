#include "sensor.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "texture.hpp"

namespace sim
{

namespace
{

constexpr int run = 64;              // pixels that take deviates from one place
constexpr size_t normals = 1u << 17; // 256 kB: stays in a core's cache
constexpr double light_unit = 64, deviation_unit = 1024, normal_unit = 4096;
constexpr Fixed half_level = 32; // to round
// A product of deviation and normal deviate has this unit; its upper 16 bits have that of light.
static_assert(deviation_unit * normal_unit == light_unit * 65536, "noise and light have one unit");

} // namespace

// Shot noise: the electrons of a pixel are Poisson distributed, so their variance is their mean.
Sensor::Sensor(const SensorSettings &settings, uint64_t seed)
{
	const double electrons_per_level = settings.full_well / 255;
	for (int light = 0; light <= 255 * light_unit; light++) {
		const double electrons = light / light_unit * electrons_per_level;
		const double electrons_rms = std::sqrt(electrons + settings.read_noise * settings.read_noise);
		const double rms = settings.noise ? electrons_rms / electrons_per_level : 0;
		deviations_.push_back(static_cast<Fixed>(std::lround(rms * deviation_unit)));
	}
	std::mt19937_64 random(hash(seed));
	std::normal_distribution<double> normal;
	for (size_t i = 0; i < normals + run; i++)
		normal_.push_back(static_cast<Fixed>(std::lround(std::clamp(normal(random), -7.9, 7.9) * normal_unit)));
}

Fixed Sensor::light(double level)
{
	return static_cast<Fixed>(std::clamp(level, 0.0, 255.0) * light_unit + 0.5);
}

double Sensor::level(Fixed light)
{
	return light / light_unit;
}

Fixed Sensor::deviation(Fixed light) const
{
	return deviations_[static_cast<size_t>(light)];
}

// Every run of pixels takes deviates from a random place of the table, with a random sign (of which the exclusive or
// makes, but for a 64th of a level, the negative). Written so that compilers turn the inner loop into vector
// instructions on 16 bits.
void Sensor::expose(const Fixed *light, const Fixed *deviation, int width, uint64_t key, uint8_t *pixels) const
{
	for (int begin = 0; begin < width; begin += run) {
		const uint64_t drawn = hash(key + static_cast<uint64_t>(begin));
		const Fixed *normal = &normal_[drawn % normals];
		const Fixed flip = drawn >> 63 ? -1 : 0;
		const int end = std::min(begin + run, width);
		for (int i = begin; i < end; i++) {
			const Fixed noise = static_cast<Fixed>((deviation[i] * normal[i - begin]) >> 16) ^ flip;
			const Fixed level = static_cast<Fixed>((light[i] + noise + half_level) >> 6);
			pixels[i] = static_cast<uint8_t>(std::min<Fixed>(std::max<Fixed>(level, 0), 255));
		}
	}
}

} // namespace sim
