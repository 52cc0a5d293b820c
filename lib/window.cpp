// Where in the next picture the ball is expected: the prediction fed back (paper, section 4.1).
#include <cmath>

#include "camera.hpp"
#include "pongeye.h"

namespace
{

const double size_uncertainty = 1.15; // the ball is at most this factor larger or smaller than expected

}

int pong_window_around(const pong_rig *rig, pong_side side, const double position[3], const pong_settings *settings,
		       pong_window *window)
{
	const pong_camera &camera = rig->camera[side];
	double uv[2];
	const double size = pong_apparent_size(&camera, position, rig->ball.diameter);
	if (!pong_project(&camera, position, uv) || !(size < 0.5 * std::min(camera.width, camera.height)))
		return PONG_NONE;
	const double reach = settings->window.margin + (0.5 + settings->window.diameters) * size;
	if (!(uv[0] > -reach && uv[0] < camera.width + reach && uv[1] > -reach && uv[1] < camera.height + reach))
		return PONG_NONE;
	window->u = static_cast<int>(std::floor(uv[0] - reach));
	window->v = static_cast<int>(std::floor(uv[1] - reach));
	window->width = window->height = static_cast<int>(std::ceil(2 * reach)) + 1;
	window->size_min = size / size_uncertainty;
	window->size_max = size * size_uncertainty;
	return PONG_FOUND;
}
