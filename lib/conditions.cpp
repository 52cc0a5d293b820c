#include "conditions.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace pong
{

namespace
{

const double gain_deadband = 0.01;    // a gain nearer to 1 is none
const double offset_deadband = 0.5;   // nor is one that shows less, grey levels
const double third_of_normal = 0.431; // a third of a normal variable's magnitudes are below, standard deviations

int32_t quantile(int32_t *values, int count, int place)
{
	std::nth_element(values, values + place, values + count);
	return values[place];
}

} // namespace

int32_t measure_gain(const CellSamples &samples)
{
	int32_t difference[CellSamples::capacity], scratch[CellSamples::capacity];
	const int count = samples.count;
	if (count < 8)
		return gain_one;
	for (int i = 0; i < count; i++)
		scratch[i] = difference[i] =
			static_cast<int32_t>(samples.now[i]) - static_cast<int32_t>(samples.then[i]);
	const int32_t offset = quantile(scratch, count, count / 2);
	if (std::abs(offset) < offset_deadband * cell_pixels)
		return gain_one;
	for (int i = 0; i < count; i++)
		scratch[i] = std::abs(difference[i] - offset);
	const int32_t near = quantile(scratch, count, count / 2);
	double now = 0, then = 0;
	for (int i = 0; i < count; i++)
		if (std::abs(difference[i] - offset) <= near) {
			now += samples.now[i];
			then += samples.then[i];
		}
	const double gain = std::clamp(now / std::max(then, 1.0), 0.25, 4.0);
	return std::abs(gain - 1) < gain_deadband ? gain_one : static_cast<int32_t>(std::lround(gain * gain_one));
}

double measure_noise(const CellSamples &samples, int32_t gain)
{
	if (samples.count == 0)
		return 0;
	int32_t magnitude[CellSamples::capacity];
	for (int i = 0; i < samples.count; i++)
		magnitude[i] = std::abs(static_cast<int32_t>(samples.now[i]) -
					static_cast<int32_t>(samples.then[i]) * gain / gain_one);
	return quantile(magnitude, samples.count, samples.count / 3) / (third_of_normal * cell_pixels);
}

} // namespace pong
