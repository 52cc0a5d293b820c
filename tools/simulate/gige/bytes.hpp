// Numbers on the wire are big-endian.
#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

namespace gige
{

using Bytes = std::vector<uint8_t>;

inline uint16_t load16(const uint8_t *from)
{
	return static_cast<uint16_t>(from[0] << 8 | from[1]);
}

inline uint32_t load32(const uint8_t *from)
{
	return static_cast<uint32_t>(load16(from)) << 16 | load16(from + 2);
}

inline void store16(uint8_t *to, uint32_t value)
{
	to[0] = static_cast<uint8_t>(value >> 8);
	to[1] = static_cast<uint8_t>(value);
}

inline void store32(uint8_t *to, uint32_t value)
{
	store16(to, value >> 16);
	store16(to + 2, value);
}

inline void append16(Bytes &to, uint32_t value)
{
	to.resize(to.size() + 2);
	store16(&to[to.size() - 2], value);
}

inline void append32(Bytes &to, uint32_t value)
{
	to.resize(to.size() + 4);
	store32(&to[to.size() - 4], value);
}

inline void append64(Bytes &to, uint64_t value)
{
	append32(to, static_cast<uint32_t>(value >> 32));
	append32(to, static_cast<uint32_t>(value));
}

// Floating point registers and chunks are IEEE 754 single precision.
inline uint32_t bits_of(float number)
{
	uint32_t bits;
	memcpy(&bits, &number, sizeof bits);
	return bits;
}

inline float number_of(uint32_t bits)
{
	float number;
	memcpy(&number, &bits, sizeof number);
	return number;
}

} // namespace gige
