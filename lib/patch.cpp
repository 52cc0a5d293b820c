#include "patch.hpp"

#include <algorithm>
#include <cstdlib>

#include "clones.hpp"

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

// The same row of three pictures.
struct Rows {
	const uint8_t *now, *then, *before;
};

} // namespace

PONG_CLONES static void row_beyond(const Rows &rows, const Gains &gains, int count, int16_t *beyond)
{
	const int32_t then_gain = gains.of[0], before_gain = gains.of[1];
	if (then_gain == gain_one && before_gain == gain_one)
		for (int i = 0; i < count; i++)
			beyond[i] = outside(rows.now[i], rows.then[i], rows.before[i]);
	else
		for (int i = 0; i < count; i++)
			beyond[i] = outside(rows.now[i], relit(rows.then[i], then_gain),
					    relit(rows.before[i], before_gain));
}

// Sums over three pixels; in[-1] and in[count] must be there.
PONG_CLONES static void sum_across(const int16_t *in, int count, int16_t *out)
{
	for (int i = 0; i < count; i++)
		out[i] = static_cast<int16_t>(in[i - 1] + in[i] + in[i + 1]);
}

// The magnitude of sums over three rows that lie one after the other; in has a row more above and one below.
PONG_CLONES static void sum_down(const int16_t *in, int width, int height, int16_t *out)
{
	for (int i = 0; i < width * height; i++)
		out[i] = static_cast<int16_t>(std::abs(in[i - width] + in[i] + in[i + width]));
}

Patch::Patch(int width, int height)
{
	beyond_.resize(static_cast<size_t>(width) + 2);
	across_.resize(static_cast<size_t>(width) * (static_cast<size_t>(height) + 2));
	level_.resize(static_cast<size_t>(width) * static_cast<size_t>(height));
}

void Patch::fill(const pong_pictures &pictures, const Gains &gains, const Area &area)
{
	area_ = area;
	const int width = area.u_end - area.u_begin, height = area.v_end - area.v_begin;
	const auto pixels = [&](const pong_image &image, int v) {
		return image.pixels + v * image.stride + area.u_begin;
	};
	int16_t *across = across_.data(); // begins and ends with a row of zeros
	beyond_[0] = beyond_[static_cast<size_t>(width) + 1] = 0;
	std::fill_n(across, width, int16_t{0});
	std::fill_n(across + (height + 1) * width, width, int16_t{0});
	for (int i = 0; i < height; i++) {
		const int v = area.v_begin + i;
		const Rows rows = {pixels(pictures.current, v), pixels(pictures.earlier[0], v),
				   pixels(pictures.earlier[1], v)};
		row_beyond(rows, gains, width, &beyond_[1]);
		sum_across(&beyond_[1], width, across + (i + 1) * width);
	}
	sum_down(across + width, width, height, level_.data());
}

} // namespace pong
