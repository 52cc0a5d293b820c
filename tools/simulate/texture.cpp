#include "texture.hpp"

#include <algorithm>
#include <cmath>

namespace sim
{

namespace
{

double lattice(int64_t x, int64_t y, uint64_t seed)
{
	const uint64_t mixed = hash(seed + 0x9e3779b97f4a7c15u * static_cast<uint64_t>(x)) + static_cast<uint64_t>(y);
	return static_cast<double>(hash(mixed) >> 11) * 0x1p-52 - 1;
}

double smooth(double s)
{
	return s * s * (3 - 2 * s);
}

// The integral of the stripes from 0 to x.
double stripes_up_to(double x, double period, double wide)
{
	const double whole = std::floor(x / period);
	return whole * wide + std::min(x - whole * period, wide);
}

} // namespace

// The finaliser of MurmurHash3.
uint64_t hash(uint64_t value)
{
	value ^= value >> 33;
	value *= 0xff51afd7ed558ccdu;
	value ^= value >> 33;
	value *= 0xc4ceb9fe1a85ec53u;
	return value ^ value >> 33;
}

// Value noise: random values on a lattice, blended between.
double noise(double x, double y, uint64_t seed)
{
	const double cell_x = std::floor(x), cell_y = std::floor(y);
	const auto i = static_cast<int64_t>(cell_x), j = static_cast<int64_t>(cell_y);
	const double s = smooth(x - cell_x), t = smooth(y - cell_y);
	const double near = lattice(i, j, seed) * (1 - s) + lattice(i + 1, j, seed) * s;
	const double far = lattice(i, j + 1, seed) * (1 - s) + lattice(i + 1, j + 1, seed) * s;
	return near * (1 - t) + far * t;
}

double stripe(double x, double footprint, double from, double to)
{
	const double low = std::max(x - footprint / 2, from), high = std::min(x + footprint / 2, to);
	return std::max(high - low, 0.0) / footprint;
}

double stripes(double x, double footprint, double period, double wide)
{
	return (stripes_up_to(x + footprint / 2, period, wide) - stripes_up_to(x - footprint / 2, period, wide)) /
	       footprint;
}

} // namespace sim
