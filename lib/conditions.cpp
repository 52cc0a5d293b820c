#include "conditions.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "clones.hpp"
#include "vectors.hpp"

namespace pong
{

namespace
{

const double gain_deadband = 0.01;           // a gain nearer to 1 is none
const int offset_deadband = cell_pixels / 2; // nor is a median change of a cell's sum below this: half a grey level
const double third_of_normal = 0.431;        // a third of a normal variable's magnitudes are below, standard deviations

} // namespace

PONG_CLONES static int count_up_to(const int16_t *values, int count, int limit)
{
	int found = 0;
	for (int i = 0; i < count; i++)
		found += values[i] <= limit;
	return found;
}

// The value that `place` others are not above, sought between bounds that double; to count is quicker than to sort.
static int quantile(const int16_t *values, int count, int place)
{
	int least = -1, most = 1;
	while (count_up_to(values, count, least) > place)
		least *= 2;
	while (count_up_to(values, count, most) <= place)
		most *= 2;
	while (least + 1 < most) { // not above least, but above most are more than that
		const int middle = least + (most - least) / 2;
		(count_up_to(values, count, middle) > place ? most : least) = middle;
	}
	return most;
}

PONG_CLONES static void differences(const CellSamples &samples, int32_t gain, int16_t *out)
{
	for (int i = 0; i < samples.count; i++)
		out[i] = static_cast<int16_t>(samples.now[i] - samples.then[i] * gain / gain_one);
}

// Whether the median of now - then is nearly none.
PONG_CLONES static bool is_as_bright(const CellSamples &samples)
{
	const int16_t deadband = offset_deadband;
	Words below = {}, not_above = {};
	for (int i = 0; i < samples.count; i += together) {
		Words difference, then;
		load(samples.now + i, difference);
		load(samples.then + i, then);
		subtract(difference, then);
		const Words inside = places < static_cast<int16_t>(samples.count - i);
		below -= inside & (difference <= -deadband);
		not_above -= inside & (difference < deadband);
	}
	return sum_of(below) <= samples.count / 2 && sum_of(not_above) > samples.count / 2;
}

int32_t measure_gain(const CellSamples &samples)
{
	int16_t difference[CellSamples::capacity], distance[CellSamples::capacity];
	const int count = samples.count;
	if (count < 8)
		return gain_one;
	if (is_as_bright(samples))
		return gain_one;
	differences(samples, gain_one, difference);
	const int offset = quantile(difference, count, count / 2);
	for (int i = 0; i < count; i++)
		distance[i] = static_cast<int16_t>(std::abs(difference[i] - offset));
	const int near = quantile(distance, count, count / 2);
	double now = 0, then = 0;
	for (int i = 0; i < count; i++)
		if (distance[i] <= near) {
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
	int16_t magnitude[CellSamples::capacity];
	differences(samples, gain, magnitude);
	for (int i = 0; i < samples.count; i++)
		magnitude[i] = static_cast<int16_t>(std::abs(magnitude[i]));
	return quantile(magnitude, samples.count, samples.count / 3) / (third_of_normal * cell_pixels);
}

} // namespace pong
