#include "patch.hpp"

#include <cstdlib>

#include "clones.hpp"

namespace pong
{

// How far each pixel lies outside of what two earlier pictures showed there, either way. A ball is seen before a
// brighter background too; where it was in one of the earlier pictures it lies inside.
PONG_CLONES void row_beyond(const uint8_t *now, const uint8_t *then, const uint8_t *before, const Gains &gains,
			    int count, int16_t *beyond)
{
	const int32_t half = gain_one / 2, then_gain = gains.of[0], before_gain = gains.of[1];
	for (int i = 0; i < count; i++) {
		const int32_t a = (then[i] * then_gain + half) / gain_one;
		const int32_t b = (before[i] * before_gain + half) / gain_one;
		const int32_t low = a < b ? a : b, high = a < b ? b : a;
		const int32_t over = now[i] - high, under = now[i] - low;
		beyond[i] = static_cast<int16_t>(over > 0 ? over : under < 0 ? under : 0);
	}
}

// in[-1] and in[count] must be there.
PONG_CLONES void sum_across(const int16_t *in, int count, int16_t *out)
{
	for (int i = 0; i < count; i++)
		out[i] = static_cast<int16_t>(in[i - 1] + in[i] + in[i + 1]);
}

PONG_CLONES void sum_down(const int16_t *above, const int16_t *here, const int16_t *below, int count, int16_t *out)
{
	for (int i = 0; i < count; i++) {
		const int sum = above[i] + here[i] + below[i];
		out[i] = static_cast<int16_t>(sum < 0 ? -sum : sum);
	}
}

Patch::Patch(int width, int height)
	: stride_(static_cast<size_t>(width) + 2), beyond_(stride_),
	  across_(stride_ * (static_cast<size_t>(height) + 2)), level_(stride_ * static_cast<size_t>(height))
{
}

void Patch::fill(const pong_pictures &pictures, const Gains &gains, const Area &area)
{
	area_ = area;
	const int width = area.u_end - area.u_begin, height = area.v_end - area.v_begin;
	const auto row = [&](const pong_image &image, int v) { return image.pixels + v * image.stride + area.u_begin; };
	beyond_[0] = beyond_[static_cast<size_t>(width) + 1] = 0;
	std::fill_n(&across_[0], width, int16_t{0});
	std::fill_n(&across_[static_cast<size_t>(height + 1) * stride_], width, int16_t{0});
	for (int i = 0; i < height; i++) {
		const int v = area.v_begin + i;
		row_beyond(row(pictures.current, v), row(pictures.earlier[0], v), row(pictures.earlier[1], v), gains,
			   width, &beyond_[1]);
		sum_across(&beyond_[1], width, &across_[static_cast<size_t>(i + 1) * stride_]);
	}
	for (int i = 0; i < height; i++) {
		const int16_t *here = &across_[static_cast<size_t>(i + 1) * stride_];
		sum_down(here - stride_, here, here + stride_, width, &level_[static_cast<size_t>(i) * stride_]);
	}
}

} // namespace pong
