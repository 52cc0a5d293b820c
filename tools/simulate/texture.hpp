// Patterns for surfaces: smooth noise and stripes, averaged over what a picture sample covers.
#pragma once

#include <cstdint>

namespace sim
{

// A well mixed number from any number.
uint64_t hash(uint64_t value);

// Smooth noise over the plane between -1 and 1, one bump a unit; `seed` tells patterns apart.
double noise(double x, double y, uint64_t seed);

// How much of the interval of width `footprint` about x lies within [from, to], 0 to 1.
double stripe(double x, double footprint, double from, double to);

// The same for stripes of width `wide` that begin at every multiple of `period`.
double stripes(double x, double footprint, double period, double wide);

} // namespace sim
