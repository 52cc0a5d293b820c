// The benchmarks, each in the file of its name.
#pragma once

namespace bench
{

// Compare calibrations.
int calibration(int argc, char **argv);

// Score a tracker's output against a simulator's truth.
int score(int argc, char **argv);

// Draw one flight.
int draw(int argc, char **argv);

// Predict simulated launches, by the library and by rivals, beside the Cramer-Rao bound.
int prediction(int argc, char **argv);

// Locate rendered balls by every method, ours and OpenCV's.
int accuracy(int argc, char **argv);

// Time every stage, beside OpenCV's way.
int speed(int argc, char **argv);

} // namespace bench
