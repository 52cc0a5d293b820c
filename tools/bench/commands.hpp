// The benchmarks, each in the file of its name.
#pragma once

namespace bench
{

// Compare calibrations.
int calibration(int argc, char **argv);

// Score a tracker's output against a simulator's truth.
int score(int argc, char **argv);

} // namespace bench
