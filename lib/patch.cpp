#include "patch.hpp"

#include <algorithm>
#include <cstdlib>

#include "clones.hpp"

namespace pong
{

// A row as it would look in today's light.
PONG_CLONES static void relight(const uint8_t *in, int32_t gain, int count, int16_t *out)
{
	const int32_t half = gain_one / 2;
	if (gain == gain_one)
		for (int i = 0; i < count; i++)
			out[i] = in[i];
	else
		for (int i = 0; i < count; i++)
			out[i] = static_cast<int16_t>((in[i] * gain + half) / gain_one);
}

// How far each pixel lies outside of what two earlier pictures showed there, either way. A ball is seen before a
// brighter background too; where it was in one of the earlier pictures it lies inside.
PONG_CLONES static void row_beyond(const uint8_t *now, const int16_t *then, const int16_t *before, int count,
				   int16_t *beyond)
{
	for (int i = 0; i < count; i++) {
		const int16_t low = std::min(then[i], before[i]), high = std::max(then[i], before[i]);
		const int16_t inside = std::min(std::max(static_cast<int16_t>(now[i]), low), high);
		beyond[i] = static_cast<int16_t>(now[i] - inside);
	}
}

// in[-1] and in[count] must be there.
PONG_CLONES static void sum_across(const int16_t *in, int count, int16_t *out)
{
	for (int i = 0; i < count; i++)
		out[i] = static_cast<int16_t>(in[i - 1] + in[i] + in[i + 1]);
}

PONG_CLONES static void sum_down(const int16_t *above, const int16_t *here, const int16_t *below, int count,
				 int16_t *out)
{
	for (int i = 0; i < count; i++) {
		const int sum = above[i] + here[i] + below[i];
		out[i] = static_cast<int16_t>(sum < 0 ? -sum : sum);
	}
}

Patch::Patch(int width, int height)
{
	for (auto *row : {&then_, &before_, &beyond_})
		row->resize(static_cast<size_t>(width) + 2);
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
	int16_t *across = across_.data(), *level = level_.data(); // across begins and ends with a row of zeros
	beyond_[0] = beyond_[static_cast<size_t>(width) + 1] = 0;
	std::fill_n(across, width, int16_t{0});
	std::fill_n(across + (height + 1) * width, width, int16_t{0});
	for (int i = 0; i < height; i++) {
		const int v = area.v_begin + i;
		relight(pixels(pictures.earlier[0], v), gains.of[0], width, then_.data());
		relight(pixels(pictures.earlier[1], v), gains.of[1], width, before_.data());
		row_beyond(pixels(pictures.current, v), then_.data(), before_.data(), width, &beyond_[1]);
		sum_across(&beyond_[1], width, across + (i + 1) * width);
	}
	for (int i = 0; i < height; i++) {
		const int16_t *here = across + (i + 1) * width;
		sum_down(here - width, here, here + width, width, level + i * width);
	}
}

} // namespace pong
