// Numbers beside each other, of which compilers make the vector instructions of the processor that they build for.
#pragma once

#include <cstdint>
#include <cstring>

namespace pong
{

using Bytes = uint8_t __attribute__((vector_size(16)));
using Words = int16_t __attribute__((vector_size(32))); // where the processor has half as long ones, two of them

using Naturals = uint16_t __attribute__((vector_size(32)));

const int together = 16; // in each
const Words places = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};

// From memory and back, aligned or not. Vectors are handed over by reference: how they are returned depends on the
// processor.
template<class Vector> inline void load(const void *numbers, Vector &vector)
{
	memcpy(&vector, numbers, sizeof vector);
}

template<class Vector> inline void store(const Vector &vector, void *numbers)
{
	memcpy(numbers, &vector, sizeof vector);
}

// The greater and the lesser of each two, in the place of the first.
template<class Vector> inline void raise_to(Vector &vector, const Vector &least)
{
	vector = vector > least ? vector : least;
}

template<class Vector> inline void lower_to(Vector &vector, const Vector &most)
{
	vector = vector < most ? vector : most;
}

// Differences and magnitudes wrap: beside the numbers that count, others may be anything.
inline void subtract(Words &words, const Words &others)
{
	words = reinterpret_cast<Words>(reinterpret_cast<Naturals>(words) - reinterpret_cast<Naturals>(others));
}

inline void take_magnitude(Words &words)
{
	Words negated = {};
	subtract(negated, words);
	raise_to(words, negated);
}

template<class Vector> inline int sum_of(const Vector &vector)
{
	int sum = 0;
	for (int i = 0; i < together; i++)
		sum += vector[i];
	return sum;
}

} // namespace pong
