#include "cells.hpp"

#include <algorithm>
#include <cstring>
#ifdef __x86_64__
#include <immintrin.h>
#endif

#include "clones.hpp"
#include "vectors.hpp"

namespace pong
{

// The pixels are read row after row, as they lie in memory: that is the order in which processors fetch ahead. To read
// four rows side by side takes three times as long when the pixels are not in the cache. Compilers would make that of
// it where they see all four: so the functions that read a row are not inlined.

namespace
{

const int cells_most = 512; // in one go

// Four neighbouring pixels in a word, added up to two sums of two.
inline uint32_t pair_sums(const uint8_t *four)
{
	const uint32_t low_bytes = 0x00ff00ff;
	uint32_t pixels;
	memcpy(&pixels, four, sizeof pixels);
	return (pixels & low_bytes) + ((pixels >> 8) & low_bytes);
}

#ifdef __x86_64__

const int vector_cells = 8; // in one vector

// Compilers do not find by themselves the instruction that adds up neighbouring bytes.
inline __attribute__((target("avx2"))) __m256i load_pairs(const uint8_t *pixels)
{
	const __m256i loaded = _mm256_loadu_si256(reinterpret_cast<const __m256i *>(pixels));
	return _mm256_maddubs_epi16(loaded, _mm256_set1_epi8(1));
}

__attribute__((target("avx2"), noinline)) void add_row(const uint8_t *pixels, int vectors, __m256i *pairs)
{
	const ptrdiff_t vector_size = sizeof *pairs;
	for (int i = 0; i < vectors; i++)
		pairs[i] = _mm256_add_epi16(pairs[i], load_pairs(pixels + i * vector_size));
}

// From sums of two neighbours to those of cells.
inline __attribute__((target("avx2"))) void store_cells(__m256i pairs, uint16_t *sums)
{
	const __m256i cells = _mm256_madd_epi16(pairs, _mm256_set1_epi16(1));
	const __m128i packed = _mm_packs_epi32(_mm256_castsi256_si128(cells), _mm256_extracti128_si256(cells, 1));
	_mm_storeu_si128(reinterpret_cast<__m128i *>(sums), packed);
}

__attribute__((target("avx2"))) void sum_vectors(const uint8_t *top, ptrdiff_t stride, int vectors, uint16_t *sums)
{
	__m256i pairs[cells_most / vector_cells];
	std::fill_n(pairs, vectors, _mm256_setzero_si256());
	for (int row = 0; row < cell_size; row++)
		add_row(top + row * stride, vectors, pairs);
	for (int i = 0; i < vectors; i++)
		store_cells(pairs[i], sums + i * vector_cells);
}

// For few cells, at least a vector of them; the last vector may overlap with the one before.
__attribute__((target("avx2"))) void sum_side_by_side(const uint8_t *top, ptrdiff_t stride, int count, uint16_t *sums)
{
	for (int i = 0; i < count; i += vector_cells) {
		const int first = std::min(i, count - vector_cells);
		__m256i pairs = _mm256_setzero_si256();
		for (int row = 0; row < cell_size; row++)
			pairs = _mm256_add_epi16(pairs, load_pairs(top + row * stride + cell_size * first));
		store_cells(pairs, sums + first);
	}
}

void sum_few_by_vectors(const uint8_t *top, ptrdiff_t stride, int count, uint16_t *sums)
{
	const int few = 32; // a window's
	if (count <= few)
		return sum_side_by_side(top, stride, count, sums);
	sum_vectors(top, stride, count / vector_cells, sums);
	const int last = count - vector_cells;
	if (count % vector_cells)
		sum_side_by_side(top + cell_size * last, stride, vector_cells, sums + last);
}

const bool has_avx2 = __builtin_cpu_supports("avx2");

#endif

} // namespace

PONG_CLONES static void add_row_plainly(const uint8_t *pixels, int count, uint32_t *pairs)
{
	for (int i = 0; i < count; i++)
		pairs[i] += pair_sums(pixels + cell_size * i);
}

PONG_CLONES static void add_pairs(const uint32_t *pairs, int count, uint16_t *sums)
{
	for (int i = 0; i < count; i++)
		sums[i] = static_cast<uint16_t>((pairs[i] & 0xffff) + (pairs[i] >> 16));
}

static void sum_few_plainly(const uint8_t *top, ptrdiff_t stride, int count, uint16_t *sums)
{
	uint32_t pairs[cells_most];
	std::fill_n(pairs, count, 0);
	for (int row = 0; row < cell_size; row++)
		add_row_plainly(top + row * stride, count, pairs);
	add_pairs(pairs, count, sums);
}

static void sum_few(const uint8_t *top, ptrdiff_t stride, int count, uint16_t *sums)
{
#ifdef __x86_64__
	if (has_avx2 && count >= vector_cells)
		return sum_few_by_vectors(top, stride, count, sums);
#endif
	sum_few_plainly(top, stride, count, sums);
}

void sum_cells(const uint8_t *top, ptrdiff_t stride, int count, uint16_t *sums)
{
	for (int i = 0; i < count; i += cells_most)
		sum_few(top + cell_size * i, stride, std::min(count - i, cells_most), sums + i);
}

void sum_cells_plainly(const uint8_t *top, ptrdiff_t stride, int count, uint16_t *sums)
{
	for (int i = 0; i < count; i += cells_most)
		sum_few_plainly(top + cell_size * i, stride, std::min(count - i, cells_most), sums + i);
}

PONG_CLONES void scale_cells(const uint16_t *sums, int count, int32_t gain, uint16_t *scaled)
{
	for (int i = 0; i < count; i++)
		scaled[i] = static_cast<uint16_t>(sums[i] * gain / gain_one);
}

PONG_CLONES int greatest_difference(const uint16_t *now, const uint16_t *then, int count)
{
	Words greatest = {};
	for (int i = 0; i < count; i += together) {
		Words difference, other;
		load(now + i, difference);
		load(then + i, other);
		subtract(difference, other);
		take_magnitude(difference);
		raise_to(greatest, difference & (places < static_cast<int16_t>(std::min(count - i, together))));
	}
	int most = 0;
	for (int i = 0; i < together; i++)
		most = std::max<int>(most, greatest[i]);
	return most;
}

PONG_CLONES void measure_outside(const uint16_t *now, const uint16_t *then, const uint16_t *before, int count,
				 int16_t *outside)
{
	for (int i = 0; i < count; i += together) {
		Words sums, low, high;
		load(now + i, sums);
		load(then + i, low);
		load(before + i, high);
		const Words one = low;
		lower_to(low, high);
		raise_to(high, one);
		Words nearest = sums;
		raise_to(nearest, low);
		lower_to(nearest, high);
		subtract(sums, nearest);
		take_magnitude(sums);
		store(sums, outside + i);
	}
}

} // namespace pong
