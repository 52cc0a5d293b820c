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
inline void outside_together(const uint8_t *now, const uint8_t *then, const uint8_t *before, Words &beyond)
{
	Bytes levels, low, high;
	load(now, levels);
	load(then, low);
	load(before, high);
	const Bytes one = low;
	lower_to(low, high);
	raise_to(high, one);
	Bytes nearest = levels;
	raise_to(nearest, low);
	lower_to(nearest, high);
	beyond = __builtin_convertvector(levels, Words) - __builtin_convertvector(nearest, Words);
}

// Of three pictures, the pixels of an area from its upper left one on.
struct Layers {
	const uint8_t *now, *then, *before;
	ptrdiff_t now_stride, then_stride, before_stride;

	Layers at(int u, int v) const
	{
		return {now + v * now_stride + u,
			then + v * then_stride + u,
			before + v * before_stride + u,
			now_stride,
			then_stride,
			before_stride};
	}

	void go_down()
	{
		now += now_stride;
		then += then_stride;
		before += before_stride;
	}
};

// How far `count` pixels of one row lie outside, in today's light; zeros after them.
inline void outside_relit(const Layers &layers, const Gains &gains, int count, Words &beyond)
{
	int16_t out[together] = {};
	for (int i = 0; i < count; i++)
		out[i] = outside(layers.now[i], relit(layers.then[i], gains.of[0]),
				 relit(layers.before[i], gains.of[1]));
	load(out, beyond);
}

// Down some columns, sums over three rows of what `measure` finds in each.
template<class Measure> inline void sum_down(Layers layers, int height, int16_t *out, ptrdiff_t stride, Measure measure)
{
	Words above = {}, middle, below;
	measure(layers, middle);
	for (int v = 1; v < height; v++, out += stride) {
		layers.go_down();
		measure(layers, below);
		store(above + middle + below, out);
		above = middle;
		middle = below;
	}
	store(above + middle, out);
}

} // namespace

// As many columns as make a vector, and then the next ones: the last may overlap. Zeros stay between the rows.
PONG_CLONES static void sum_columns_down(const Layers &layers, const Gains &gains, int width, int height, int16_t *sums,
					 ptrdiff_t stride)
{
	const bool as_today = gains.of[0] == gain_one && gains.of[1] == gain_one;
	const int count = std::min(width, together);
	for (int v = 0; v < height; v++)
		store(Words{}, sums + v * stride + width);
	for (int begin = 0; begin < width; begin += together) {
		const int first = std::min(begin, width - count);
		const Layers columns = layers.at(first, 0);
		if (as_today && count == together)
			sum_down(columns, height, sums + first, stride, [](const Layers &at, Words &beyond) {
				outside_together(at.now, at.then, at.before, beyond);
			});
		else
			sum_down(columns, height, sums + first, stride,
				 [&](const Layers &at, Words &beyond) { outside_relit(at, gains, count, beyond); });
	}
}

// The magnitude of sums over three neighbours, in place, but so many earlier as make a vector: what is written is read
// no more.
PONG_CLONES static void sum_across(int16_t *sums, ptrdiff_t count)
{
	for (ptrdiff_t i = 0; i < count; i += together) {
		Words sum, left, right;
		load(sums + i, sum);
		load(sums + i - 1, left);
		load(sums + i + 1, right);
		sum += left + right;
		take_magnitude(sum);
		store(sum, sums + i - together);
	}
}

// Rows are so far apart that there is a place for a zero between them, and vectors fit.
static ptrdiff_t stride_of(int width)
{
	return (width / together + 1) * together;
}

Patch::Patch(int width, int height)
{
	level_.resize(static_cast<size_t>(stride_of(width) * height + 2 * together));
}

void Patch::fill(const pong_pictures &pictures, const Gains &gains, const Area &area)
{
	area_ = area;
	const int width = area.u_end - area.u_begin, height = area.v_end - area.v_begin;
	stride_ = stride_of(width);
	const pong_image &now = pictures.current, &then = pictures.earlier[0], &before = pictures.earlier[1];
	const Layers layers = {now.pixels, then.pixels, before.pixels, now.stride, then.stride, before.stride};
	int16_t *const sums = level_.data() + together;
	std::fill_n(level_.data(), together, int16_t{0}); // beside the first pixel
	sum_columns_down(layers.at(area.u_begin, area.v_begin), gains, width, height, sums, stride_);
	sum_across(sums, stride_ * height);
}

} // namespace pong
