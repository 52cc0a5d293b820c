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

PONG_CLONES void sum_cells(const uint8_t *top, ptrdiff_t stride, int count, const uint8_t *ahead, uint32_t *sums)
{
	const int cache_line = 64; // bytes
	if (ahead)
		for (int row = 0; row < cell_size; row++)
			for (int u = 0; u < cell_size * count; u += cache_line)
				__builtin_prefetch(ahead + row * stride + u);
	const uint8_t *second = top + stride, *third = second + stride, *fourth = third + stride;
	for (int i = 0; i < count; i++) {
		const int u = cell_size * i;
		const uint32_t pairs =
			pair_sums(top + u) + pair_sums(second + u) + pair_sums(third + u) + pair_sums(fourth + u);
		sums[i] = (pairs & 0xffff) + (pairs >> 16);
	}
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
