#include "worth_keeping.hpp"

#include <algorithm>
#include <cmath>

namespace track
{

namespace
{

constexpr int64_t WHOLE_EVERY = 1000000; // us, where there is no ball
constexpr int64_t FOLLOWED = 300000;     // us: how long a ball that is no longer seen is looked for where it flew to
constexpr double MARGIN = 32;            // px around the ball,
constexpr double DIAMETERS = 2;          // and so many of its diameters: more than the tracker looks at

Part clip(const pong_window &window, const pong_camera &camera)
{
	const int left = std::clamp(window.u, 0, camera.width), top = std::clamp(window.v, 0, camera.height);
	const int right = std::clamp(window.u + window.width, left, camera.width);
	const int bottom = std::clamp(window.v + window.height, top, camera.height);
	return {left, top, right - left, bottom - top};
}

} // namespace

WorthKeeping::WorthKeeping(const pong_rig &rig, const pong_settings &settings) : rig_(rig), settings_(settings)
{
	settings_.window.margin = std::max(settings.window.margin, MARGIN);
	settings_.window.diameters = std::max(settings.window.diameters, DIAMETERS);
}

// Straight on from where it was seen last: the window is wide enough for what gravity adds.
bool WorthKeeping::expect_ball(int64_t utime, double position[3]) const
{
	const int64_t elapsed = utime - ball_.utime;
	if (!has_ball_ || elapsed < 0 || elapsed > FOLLOWED)
		return false;
	for (int i = 0; i < 3; i++) {
		const double velocity = std::isfinite(ball_.velocity[i]) ? ball_.velocity[i] : 0;
		position[i] = ball_.position[i] + velocity * static_cast<double>(elapsed) * 1e-6;
	}
	return true;
}

Parts WorthKeeping::choose(const StereoPair &pair, const pong_sight &sight)
{
	if (!has_whole_ || (!sight.has_ball && pair.utime - whole_utime_ >= WHOLE_EVERY)) {
		has_whole_ = true;
		whole_utime_ = pair.utime;
		return whole_of(pair);
	}
	if (sight.has_ball) {
		has_ball_ = true;
		ball_ = sight.ball;
	}
	Parts parts;
	double position[3];
	pong_window window;
	if (expect_ball(pair.utime, position))
		for (const pong_side side : {PONG_LEFT, PONG_RIGHT})
			if (pong_window_around(&rig_, side, position, &settings_, &window))
				parts.of[side] = clip(window, rig_.camera[side]);
	return parts;
}

} // namespace track
