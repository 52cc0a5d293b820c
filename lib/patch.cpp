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

} // namespace

// How far the area's pixels lie outside, and zeros between the rows of it, which lie `stride` apart.
PONG_CLONES static void measure_beyond(const Layers &layers, const Gains &gains, int width, int height,
				       ptrdiff_t stride, int16_t *beyond)
{
	const int32_t then_gain = gains.of[0], before_gain = gains.of[1];
	const bool relights = then_gain != gain_one || before_gain != gain_one;
	for (int v = 0; v < height; v++, beyond += stride) {
		const uint8_t *now = layers.now + v * layers.now_stride, *then = layers.then + v * layers.then_stride,
			      *before = layers.before + v * layers.before_stride;
		if (relights || width < bytes_together)
			for (int i = 0; i < width; i++)
				beyond[i] = outside(now[i], relit(then[i], then_gain), relit(before[i], before_gain));
		else
			for (int begin = 0; begin < width; begin += bytes_together) {
				const int i = std::min(begin, width - bytes_together); // the last may overlap
				outside_together(now + i, then + i, before + i, beyond + i);
			}
		memset(beyond + width, 0, bytes_together * sizeof *beyond); // up to the next row, or some of it
	}
}

// Sums over three neighbours; in[-1] and in[count] must be there.
PONG_CLONES static void sum_across(const int16_t *in, ptrdiff_t count, int16_t *out)
{
	for (ptrdiff_t i = 0; i < count; i++)
		out[i] = static_cast<int16_t>(in[i - 1] + in[i] + in[i + 1]);
}

// The magnitude of sums over three rows; in has a row more above and one below.
PONG_CLONES static void sum_down(const int16_t *in, ptrdiff_t stride, ptrdiff_t count, int16_t *out)
{
	for (ptrdiff_t i = 0; i < count; i++) {
		const int16_t sum = static_cast<int16_t>(in[i - stride] + in[i] + in[i + stride]);
		out[i] = std::max(sum, static_cast<int16_t>(-sum)); // narrow: so many more at once
	}
}

// Rows are so far apart that there is a place for a zero between them, and vectors fit.
static ptrdiff_t stride_of(int width)
{
	return (width / bytes_together + 1) * bytes_together;
}

Patch::Patch(int width, int height)
{
	const size_t pixels = static_cast<size_t>(stride_of(width)) * (static_cast<size_t>(height) + 2);
	beyond_.resize(pixels + 2);
	across_.resize(pixels);
	level_.resize(pixels);
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
	// Zeros all around, a row above and one below.
	int16_t *const first = beyond_.data() + 1, *const inside = first + stride_;
	std::fill(first - 1, inside, int16_t{0});
	measure_beyond({pixels(now), pixels(then), pixels(before), now.stride, then.stride, before.stride}, gains,
		       width, height, stride_, inside);
	std::fill_n(inside + height * stride_, stride_ + 1, int16_t{0});
	sum_across(first, (height + 2) * stride_, across_.data());
	sum_down(across_.data() + stride_, stride_, height * stride_, level_.data());
}

} // namespace pong
