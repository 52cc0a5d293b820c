// What to keep of the pictures where a recording is to be small: windows around the ball, and once in a while, when
// there is no ball, whole pictures, from which a replay has what is behind it.
#pragma once

#include "pair_message.hpp"
#include "pongeye.h"

namespace track
{

class WorthKeeping
{
public:
	WorthKeeping(const pong_rig &rig, const pong_settings &settings);

	Parts choose(const StereoPair &pair, const pong_sight &sight);

private:
	bool expect_ball(int64_t utime, double position[3]) const;

	pong_rig rig_;
	pong_settings settings_; // with a wider window than the tracker looks into
	bool has_whole_ = false;
	int64_t whole_utime_ = 0;
	bool has_ball_ = false;
	pong_ball ball_ = {}; // the last one
};

} // namespace track
