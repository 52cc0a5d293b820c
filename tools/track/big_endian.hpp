// Numbers as LCM writes them.
#pragma once

#include <cstdint>

namespace track
{

inline uint32_t load32(const uint8_t *bytes)
{
	return uint32_t{bytes[0]} << 24 | uint32_t{bytes[1]} << 16 | uint32_t{bytes[2]} << 8 | bytes[3];
}

inline int64_t load64(const uint8_t *bytes)
{
	return static_cast<int64_t>(uint64_t{load32(bytes)} << 32 | load32(bytes + 4));
}

inline void store32(uint8_t *bytes, uint32_t value)
{
	for (int i = 0; i < 4; i++)
		bytes[i] = static_cast<uint8_t>(value >> (24 - 8 * i));
}

} // namespace track
