#include "cells.hpp"

#include <cstring>

#include "clones.hpp"

namespace pong
{

namespace
{

// Four neighbouring pixels in a word, added up to two sums of two.
inline uint32_t pair_sums(const uint8_t *four)
{
	const uint32_t low_bytes = 0x00ff00ff;
	uint32_t pixels;
	memcpy(&pixels, four, sizeof pixels);
	return (pixels & low_bytes) + ((pixels >> 8) & low_bytes);
}

} // namespace

// Row after row, as they lie in memory: that is the order in which processors fetch ahead.
PONG_CLONES void sum_cells(const uint8_t *top, ptrdiff_t stride, int count, uint32_t *sums)
{
	for (int i = 0; i < count; i++)
		sums[i] = pair_sums(top + cell_size * i);
	for (int row = 1; row < cell_size; row++) {
		const uint8_t *pixels = top + row * stride;
		for (int i = 0; i < count; i++)
			sums[i] += pair_sums(pixels + cell_size * i);
	}
	for (int i = 0; i < count; i++)
		sums[i] = (sums[i] & 0xffff) + (sums[i] >> 16);
}

PONG_CLONES bool subtract_cells(const uint32_t *now, const uint32_t *then, int32_t gain, int32_t threshold, int count,
				int32_t *difference)
{
	int32_t outside = 0;
	for (int i = 0; i < count; i++) {
		const int32_t expected = static_cast<int32_t>(then[i]) * gain / gain_one;
		const int32_t d = static_cast<int32_t>(now[i]) - expected;
		difference[i] = d;
		outside |= (d > threshold) | (d < -threshold);
	}
	return outside != 0;
}

} // namespace pong
