// Where in the next pictures the ball is expected.
#pragma once

#include "pongeye.h"

namespace pong
{

// As pong_window_around, and as much larger as the state is uncertain.
bool window_around(const pong_rig &rig, pong_side side, const pong_state &expected, const pong_settings &settings,
		   pong_window *window);

// As pong_window_around, and so much larger, m.
bool window_around(const pong_rig &rig, pong_side side, const double position[3], double metres,
		   const pong_settings &settings, pong_window *window);

} // namespace pong
