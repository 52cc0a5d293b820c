// Where in the next picture the ball is expected: the prediction fed back (paper, section 4.1).
#include "window.hpp"

#include <algorithm>
#include <cmath>

#include "camera.hpp"

namespace
{

// The ball is at most this factor larger or smaller than expected; the paper's points need some room.
const double size_uncertainty = 1.15, size_uncertainty_paper = 1.4;
const double sigmas = 4;      // of where the ball is expected, around the least window
const double more_most = 100; // px

} // namespace

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
	const double factor =
		settings->detect.method == PONG_DETECT_DIFFERENCE ? size_uncertainty_paper : size_uncertainty;
	window->size_min = size / factor;
	window->size_max = size * factor;
	return PONG_FOUND;
}

namespace pong
{

bool window_around(const pong_rig &rig, pong_side side, const pong_state &expected, const pong_settings &settings,
		   pong_window *window)
{
	double variance = 0;
	for (int axis = 0; axis < 3 && expected.has_spin; axis++) // the paper's state has no covariance
		variance = std::max(variance, expected.covariance[axis][axis]);
	return window_around(rig, side, expected.position, sigmas * std::sqrt(variance), settings, window);
}

bool window_around(const pong_rig &rig, pong_side side, const double position[3], double metres,
		   const pong_settings &settings, pong_window *window)
{
	if (!pong_window_around(&rig, side, position, &settings, window))
		return false;
	const double diameter = rig.ball.diameter;
	const double px_per_metre = pong_apparent_size(&rig.camera[side], position, diameter) / diameter;
	const int px = static_cast<int>(std::ceil(std::min(metres * px_per_metre, more_most)));
	window->u -= px;
	window->v -= px;
	window->width += 2 * px;
	window->height += 2 * px;
	return true;
}

} // namespace pong
