// Numbers beside each other, of which compilers make the vector instructions of the processor that they build for.
#pragma once

#include <cstdint>
#include <cstring>

namespace pong
{

using Bytes = uint8_t __attribute__((vector_size(16)));
using HalfBytes = uint8_t __attribute__((vector_size(8)));
using Words = int16_t __attribute__((vector_size(16)));

const int bytes_together = 16, words_together = 8;

// From memory and back, aligned or not.
template<class Vector> inline Vector load(const void *numbers)
{
	Vector vector;
	memcpy(&vector, numbers, sizeof vector);
	return vector;
}

template<class Vector> inline void store(const Vector &vector, void *numbers)
{
	memcpy(numbers, &vector, sizeof vector);
}

// The greater and the lesser of each two.
template<class Vector> inline Vector greater(const Vector &a, const Vector &b)
{
	return a > b ? a : b;
}

template<class Vector> inline Vector lesser(const Vector &a, const Vector &b)
{
	return a < b ? a : b;
}

} // namespace pong
