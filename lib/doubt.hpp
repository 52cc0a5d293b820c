// Is it a ball, or something else that moves? Two centres of a ball agree better than those of anything else, and its
// outline is seen all round.
#pragma once

#include "pongeye.h"

namespace pong
{

// Whether two places that look like a ball may be the same one, as far as can be told before their centres are known.
bool may_be_one(const pong_rig &rig, const pong_detection &left, const pong_detection &right);

// How badly the two centres of a point agree, with each other's epipolar lines and with its distance: below 1 as a
// ball's do, above as a ball's hardly ever.
double doubt_of_centres(const pong_rig &rig, const pong_centre &left, const pong_centre &right,
			const pong_point &point);

// The same of the part of a ball's outline that shows.
double doubt_of_outline(double shown);

} // namespace pong
