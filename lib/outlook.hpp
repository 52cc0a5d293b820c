// The flight to come from a state with spin, and how sure it is.
#pragma once

#include "pongeye.h"

namespace pong
{

// A state without spin flies as if it had none, and nothing is known of the errors. False if it is not finite.
bool look_ahead(const pong_rig &rig, const pong_state &state, const pong_settings &settings,
		pong_prediction &prediction);

// The state at a later time. False where that is too far ahead, or the state not finite.
bool look_ahead_to(const pong_rig &rig, const pong_state &state, int64_t utime, const pong_settings &settings,
		   pong_state &then);

} // namespace pong
