// A closer look at what may be the ball amid what else moves.
#pragma once

#include "expect.hpp"
#include "side.hpp"

namespace pong
{

// Amid what else moves only a part of a ball may be seen as new, and what is seen too large or too small is not located
// well. Look again: where the ball is expected, unless that is null; and for each ball that one camera has located,
// where the other one must see it. The sides get new places. Where no flight is followed, only what is fresh is looked
// at.
void look_closer(const pong_rig &rig, Side &left, Side &right, const Expected *expected, bool followed);

} // namespace pong
