#include "patch.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "clones.hpp"
#include "vectors.hpp"

namespace pong
{

namespace
{

// A grey level as it would be in today's light.
inline int16_t relit(uint8_t level, int32_t gain)
{
	return static_cast<int16_t>((level * gain + gain_one / 2) / gain_one);
}

// How far a pixel lies outside of what two earlier pictures showed there, either way. A ball is seen before a brighter
// background too; where it was in one of the earlier pictures it lies inside.
inline int16_t outside(int16_t now, int16_t then, int16_t before)
{
	const int16_t low = std::min(then, before), high = std::max(then, before);
	return static_cast<int16_t>(now - std::min(std::max(now, low), high));
}

// The same of as many pixels as make a vector.
inline void outside_together(const uint8_t *now, const uint8_t *then, const uint8_t *before, int16_t *beyond)
{
	const Bytes levels = load<Bytes>(now), one = load<Bytes>(then), other = load<Bytes>(before);
	const Bytes low = lesser(one, other), high = greater(one, other);
	const Bytes above = greater(levels, high) - high, below = low - lesser(levels, low);
	HalfBytes halves[2][2];
	store(above, halves[0]);
	store(below, halves[1]);
	for (int i = 0; i < 2; i++)
		store(__builtin_convertvector(halves[0][i], Words) - __builtin_convertvector(halves[1][i], Words),
		      beyond + words_together * i);
}

// Of three pictures, the pixels of an area from its upper left one on.
struct Layers {
	const uint8_t *now, *then, *before;
	ptrdiff_t now_stride, then_stride, before_stride;
};

// How far pixels of one row lie outside, and zeros beside the last one.
inline void measure_row(const Layers &layers, const Gains &gains, int v, int width, int16_t *beyond)
{
	const uint8_t *now = layers.now + v * layers.now_stride, *then = layers.then + v * layers.then_stride,
		      *before = layers.before + v * layers.before_stride;
	if (gains.of[0] != gain_one || gains.of[1] != gain_one || width < bytes_together)
		for (int i = 0; i < width; i++)
			beyond[i] = outside(now[i], relit(then[i], gains.of[0]), relit(before[i], gains.of[1]));
	else
		for (int begin = 0; begin < width; begin += bytes_together) {
			const int i = std::min(begin, width - bytes_together); // the last may overlap
			outside_together(now + i, then + i, before + i, beyond + i);
		}
	store(Words{}, beyond + width);
	store(Words{}, beyond + width + words_together);
}

// Sums over three rows.
inline void sum_down(const int16_t *above, const int16_t *middle, const int16_t *below, int width, int16_t *out)
{
	for (int i = 0; i < width; i += words_together)
		store(load<Words>(above + i) + load<Words>(middle + i) + load<Words>(below + i), out + i);
}

// The magnitude of sums over three neighbours; in[-1] must be there.
inline void sum_across(const int16_t *in, int width, int16_t *out)
{
	for (int i = 0; i < width; i += words_together) {
		const Words sum = load<Words>(in + i - 1) + load<Words>(in + i) + load<Words>(in + i + 1);
		store(greater(sum, -sum), out + i);
	}
}

const int rows_kept = 5; // while levels are summed

} // namespace

// Row by row: what is in between stays in the cache. What was summed down one row ago is summed across, for processors
// wait where they read otherwise what they have just written. `rows` has room for those kept, `pitch` apart.
PONG_CLONES static void sum_around(const Layers &layers, const Gains &gains, int width, int height, int16_t *rows,
				   ptrdiff_t pitch, ptrdiff_t stride, int16_t *level)
{
	int16_t *above = rows, *middle = above + pitch, *below = middle + pitch;
	int16_t *down = below + pitch, *down_before = down + pitch;
	const auto clear = [&](int16_t *row) { std::fill_n(row, pitch, int16_t{0}); };
	clear(middle);
	down[-1] = down_before[-1] = 0;
	measure_row(layers, gains, 0, width, below);
	for (int v = 0; v <= height; v++) {
		std::swap(above, middle);
		std::swap(middle, below);
		std::swap(down, down_before);
		if (v + 1 < height)
			measure_row(layers, gains, v + 1, width, below);
		else
			clear(below);
		if (v < height)
			sum_down(above, middle, below, width + 1, down);
		if (v > 0)
			sum_across(down_before, width, level + (v - 1) * stride);
	}
}

// Rows are so far apart that there is a place for a zero between them, and vectors fit.
static ptrdiff_t stride_of(int width)
{
	return (width / bytes_together + 1) * bytes_together;
}

Patch::Patch(int width, int height)
{
	const size_t stride = static_cast<size_t>(stride_of(width));
	rows_.resize(rows_kept * (stride + bytes_together) + bytes_together);
	level_.resize(stride * static_cast<size_t>(height) + bytes_together);
}

void Patch::fill(const pong_pictures &pictures, const Gains &gains, const Area &area)
{
	area_ = area;
	const int width = area.u_end - area.u_begin, height = area.v_end - area.v_begin;
	stride_ = stride_of(width);
	const auto pixels = [&](const pong_image &image) {
		return image.pixels + area.v_begin * image.stride + area.u_begin;
	};
	const pong_image &now = pictures.current, &then = pictures.earlier[0], &before = pictures.earlier[1];
	sum_around({pixels(now), pixels(then), pixels(before), now.stride, then.stride, before.stride}, gains, width,
		   height, rows_.data() + bytes_together, stride_ + bytes_together, stride_, level_.data());
}

} // namespace pong
