// The benchmarks, each in the file of its name.
#pragma once

namespace bench
{

// Score a tracker's output against a simulator's truth.
int score(int argc, char **argv);

} // namespace bench
