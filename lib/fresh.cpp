#include "fresh.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "clones.hpp"
#include "conditions.hpp"
#include "picture_ring.hpp"

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

const int motion = PictureRing::margin; // px, to all sides
const int rows_compared = 24;           // of an area
const int unlike = 40;                  // more does not count, grey levels: a ball is not to be followed

} // namespace

// The sum of how much pixels differ from the more alike of two others.
PONG_CLONES static int32_t row_difference(const uint8_t *now, const uint8_t *one, const uint8_t *other, int count)
{
	int32_t sum = 0;
	for (int i = 0; i < count; i++) {
		const int32_t a = std::abs(now[i] - one[i]), b = std::abs(now[i] - other[i]);
		const int32_t less = a < b ? a : b;
		sum += less < unlike ? less : unlike;
	}
	return sum;
}

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
		const auto sum = [&](const pong_image &image, uint16_t *out) {
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
	const auto shown = [&](int above) {
		return above >= first && above <= last &&
		       least_difference(cell, previous.pixels + above * previous.stride + begin, previous.stride) <=
			       cell_pixels * level;
	};
	// Most of what is not fresh has hardly moved.
	for (int away = 0; away <= down; away++)
		if (shown(v - away) || shown(v + away))
			return false;
	return true;
}

namespace
{

pong_image moved(const pong_image &image, int du, int dv)
{
	return {image.pixels + dv * image.stride + du, image.width, image.height, image.stride};
}

// The motion that best explains the area together with another one, or by itself.
pong_image best_moved(const pong_image &now, const pong_image &earlier, const Area &area, const pong_image *other)
{
	const int every = std::max(1, (area.v_end - area.v_begin) / rows_compared);
	const int up = std::min(motion, area.v_begin), down_most = std::min(motion, now.height - area.v_end);
	const int left = std::min(motion, area.u_begin), right = std::min(motion, now.width - area.u_end);
	pong_image best = earlier;
	int32_t least = INT32_MAX;
	for (int dv = -up; dv <= down_most; dv++)
		for (int du = -left; du <= right; du++) {
			const pong_image candidate = moved(earlier, du, dv);
			int32_t sum = std::abs(du) + std::abs(dv); // what rests, rather than what moves
			for (int v = area.v_begin; v < area.v_end && sum < least; v += every) {
				const auto row = [&](const pong_image &image) {
					return image.pixels + v * image.stride + area.u_begin;
				};
				sum += row_difference(row(now), row(candidate), row(other ? *other : candidate),
						      area.u_end - area.u_begin);
			}
			if (sum < least) {
				least = sum;
				best = candidate;
			}
		}
	return best;
}

} // namespace

Moved follow_motion(const pong_image &now, const pong_image &earlier, const Area &area)
{
	const pong_image first = best_moved(now, earlier, area, nullptr);
	return {{first, best_moved(now, earlier, area, &first)}};
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
