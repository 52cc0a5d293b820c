#include "fresh.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "clones.hpp"
#include "conditions.hpp"

namespace pong
{

namespace
{

const int across = 8;         // places compared beside each other: 4 px to either side, less one
const int down = 4;           // px, up and down
const double reach_part = 1;  // of a circle's radius, compared to all sides: 2 m/s at 110 Hz, for a ball's size
const int reach_least = 4;    // px,
const int reach_most = 12;    // and at most
const int samples_across = 5; // of a circle's radius

uint8_t pixel(const pong_image &image, int u, int v)
{
	return image.pixels[v * image.stride + u];
}

// What the previous picture would show as this level.
int before_flicker(int level, int32_t gain)
{
	return (level * gain_one + gain / 2) / gain;
}

// The pixels of a circle, few enough of them.
struct Disc {
	static const int capacity = 256;
	int count = 0;
	int u[capacity], v[capacity];
	int level[capacity]; // as the previous picture would show it

	Disc(const pong_image &image, int32_t gain, double at_u, double at_v, double radius)
	{
		const double step = std::max(1.0, radius / samples_across);
		for (double y = -radius; y <= radius; y += step)
			for (double x = -radius; x <= radius; x += step) {
				const int column = static_cast<int>(std::lround(at_u + x));
				const int row = static_cast<int>(std::lround(at_v + y));
				if (x * x + y * y > radius * radius || count == capacity || column < 0 || row < 0 ||
				    column >= image.width || row >= image.height)
					continue;
				level[count] = before_flicker(pixel(image, column, row), gain);
				u[count] = column;
				v[count++] = row;
			}
	}
};

// The mean difference of the disc's pixels from those of the picture before, (du, dv) away, if it is below `most`.
double difference(const pong_image &previous, const Disc &disc, int du, int dv, double most)
{
	int sum = 0, count = 0;
	for (int i = 0; i < disc.count; i++) {
		const int u = disc.u[i] + du, v = disc.v[i] + dv;
		if (u < 0 || v < 0 || u >= previous.width || v >= previous.height)
			continue;
		sum += std::abs(disc.level[i] - pixel(previous, u, v));
		count++;
		if (sum > most * disc.count)
			return most;
	}
	return 2 * count >= disc.count ? std::min(most, static_cast<double>(sum) / count) : most;
}

} // namespace

// The least of the sums of differences of a cell from `across` places beside each other.
PONG_CLONES static int32_t least_difference(const uint8_t *cell, const uint8_t *then, ptrdiff_t then_stride)
{
	uint16_t sums[across] = {};
	for (int v = 0; v < cell_size; v++)
		for (int u = 0; u < cell_size; u++) {
			const int16_t level = cell[v * cell_size + u];
			const uint8_t *beside = then + v * then_stride + u;
			for (int i = 0; i < across; i++)
				sums[i] = static_cast<uint16_t>(sums[i] + std::abs(level - beside[i]));
		}
	return *std::min_element(sums, sums + across);
}

int32_t gain_between(const pong_image &now, const pong_image &previous)
{
	CellSamples samples;
	const int columns = now.width / cell_size, rows = now.height / cell_size;
	for (int i = 0; i < CellSamples::capacity; i++) {
		// Scattered evenly over the picture: steps of the golden section, in both directions.
		const int column = static_cast<int>(columns * std::fmod(0.7548777 * i, 1.0));
		const int row = static_cast<int>(rows * std::fmod(0.5698403 * i, 1.0));
		const auto sum = [&](const pong_image &image, uint32_t *out) {
			sum_cells(image.pixels + row * cell_size * image.stride + column * cell_size, image.stride, 1,
				  out);
		};
		sum(now, &samples.now[i]);
		sum(previous, &samples.then[i]);
	}
	samples.count = CellSamples::capacity;
	return measure_gain(samples);
}

bool is_fresh_cell(const pong_image &now, const pong_image &previous, int32_t gain, int column, int row, double level)
{
	const int u = column * cell_size, v = row * cell_size;
	uint8_t cell[cell_pixels];
	for (int i = 0; i < cell_pixels; i++)
		cell[i] = static_cast<uint8_t>(
			std::min(255, before_flicker(pixel(now, u + i % cell_size, v + i / cell_size), gain)));
	const int begin = std::clamp(u - across / 2, 0, now.width - across - cell_size);
	const int first = std::max(0, v - down), last = std::min(now.height - cell_size, v + down);
	for (int above = first; above <= last; above++)
		if (least_difference(cell, previous.pixels + above * previous.stride + begin, previous.stride) <=
		    cell_pixels * level)
			return false;
	return true;
}

double freshness(const pong_image &now, const pong_image &previous, int32_t gain, double u, double v, double radius)
{
	const Disc disc(now, gain, u, v, radius + 1);
	const int reach = std::clamp(static_cast<int>(reach_part * radius), reach_least, reach_most);
	double least = 255;
	for (int dv = -reach; dv <= reach; dv++)
		for (int du = -reach; du <= reach; du++)
			least = difference(previous, disc, du, dv, least);
	return least;
}

} // namespace pong
