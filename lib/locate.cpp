// The ball's centre to a part of a pixel: on the original picture, not on the binary one.
#include "locate.hpp"

#include <cmath>

namespace pong
{

namespace
{

bool locate(const LocateTask &task, pong_locate_method method, pong_centre *centre)
{
	switch (method) {
	case PONG_LOCATE_GAUSSIAN:
		return locate_gaussian(task, centre);
	case PONG_LOCATE_CENTROID:
		return locate_centroid(task, centre);
	case PONG_LOCATE_EDGES:
		return locate_edges(task, centre);
	case PONG_LOCATE_PHOTOMETRIC:
		return locate_photometric(task, centre);
	}
	return false;
}

const double farthest = 6; // diameters that a ball moves from one pair to the next

} // namespace

} // namespace pong

int pong_locate(const pong_camera *camera, const pong_pictures *pictures, const pong_detection *detection,
		const double streak[3], const pong_settings *settings, pong_centre *centre)
{
	const pong::LocateTask task = {*camera,
				       *pictures,
				       *detection,
				       streak ? pong::Vector2(streak[0], streak[1]) : pong::Vector2(0, 0),
				       streak ? streak[2] : 0,
				       settings->locate.sigma};
	// A centre outside of the ball is a fit gone wrong.
	if (!pong::locate(task, settings->locate.method, centre) ||
	    !(std::hypot(centre->u - detection->u, centre->v - detection->v) < detection->size / 2))
		return PONG_NONE;
	return PONG_FOUND;
}

int pong_streak(const pong_camera *camera, const double position[3], const double velocity[3], double exposure,
		double streak[3])
{
	double begin[3], end[3], begin_uv[2], end_uv[2];
	for (int axis = 0; axis < 3; axis++) {
		begin[axis] = position[axis] - velocity[axis] * exposure / 2;
		end[axis] = position[axis] + velocity[axis] * exposure / 2;
	}
	if (!pong_project(camera, begin, begin_uv) || !pong_project(camera, end, end_uv))
		return PONG_NONE;
	streak[0] = end_uv[0] - begin_uv[0];
	streak[1] = end_uv[1] - begin_uv[1];
	const double one = 1; // m; the ratio does not depend on it
	const double size = pong_apparent_size(camera, position, one);
	streak[2] = (pong_apparent_size(camera, end, one) - pong_apparent_size(camera, begin, one)) / size;
	return PONG_FOUND;
}

int pong_streak_since(const pong_camera *camera, const double position[3], double seconds, const pong_detection *now,
		      double exposure, double streak[3])
{
	double before[2];
	if (!(seconds > 0) || !pong_project(camera, position, before))
		return PONG_NONE;
	const double moved[2] = {now->u - before[0], now->v - before[1]};
	if (!(std::hypot(moved[0], moved[1]) <= pong::farthest * now->size))
		return PONG_NONE;
	for (int axis = 0; axis < 2; axis++)
		streak[axis] = moved[axis] * exposure / seconds;
	streak[2] = 0;
	return PONG_FOUND;
}
