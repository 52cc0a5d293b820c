// Recorded flights, predicted one after another by coefficients that the others taught: no flight judges itself.
#pragma once

#include <string>
#include <vector>

namespace bench
{

// Predict every flight of the file from its points up to T = 0.12, 0.20, 0.28 ... s the position at T + 0.1 ... 0.4 s,
// by the paper's way and by ours, and print medians and 90 % per class: the part of a flight's name before its last
// hyphen. `folds` fits: each on all flights but a part; 0: the library's own coefficients.
void score_recorded(const std::string &path, int folds);

} // namespace bench
