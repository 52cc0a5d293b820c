// The methods of detection, each in a file of its own.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>

#include "pongeye.h"

namespace pong
{

class DetectMethod
{
public:
	virtual ~DetectMethod() = default;

	// As pong_detect; capacity is at least 1.
	virtual int detect(const pong_pictures &pictures, const pong_window *window, pong_detection *found,
			   int capacity) = 0;

	// As pong_detector_remember.
	virtual void remember(const pong_image &)
	{
	}

	// Tell the picture right before the next search's current one, or null: then what moves slowly may be a ball.
	virtual void set_previous(const pong_image *)
	{
	}

	// Whether something moved where the last search looked that is neither a ball nor noise.
	virtual bool cluttered() const
	{
		return false;
	}
};

bool cluttered(const pong_detector &detector);

// As pong_detect, where the picture right before the current one is known.
int detect(pong_detector &detector, const pong_pictures &pictures, const pong_image *previous,
	   const pong_window *window, pong_detection *found, int capacity);

// The region outlives them.
std::unique_ptr<DetectMethod> make_difference(const pong_region &region, const pong_settings &settings);
std::unique_ptr<DetectMethod> make_double_difference(const pong_region &region, const pong_settings &settings);

// A rectangle, [begin, end) in both directions.
struct Area {
	int u_begin, u_end, v_begin, v_end;

	bool empty() const
	{
		return u_begin >= u_end || v_begin >= v_end;
	}

	bool contains(int u, int v) const
	{
		return u >= u_begin && u < u_end && v >= v_begin && v < v_end;
	}
};

inline Area intersect(const Area &a, const Area &b)
{
	return {std::max(a.u_begin, b.u_begin), std::min(a.u_end, b.u_end), std::max(a.v_begin, b.v_begin),
		std::min(a.v_end, b.v_end)};
}

// The part of a picture that is searched: the window's, or all of it.
inline Area searched_area(int width, int height, const pong_window *window)
{
	const Area picture = {0, width, 0, height};
	if (!window)
		return picture;
	return intersect(picture, {window->u, window->u + window->width, window->v, window->v + window->height});
}

// Whether one of found[count] lies where this one does.
inline bool is_known(const pong_detection &ball, const pong_detection *found, int count)
{
	return std::any_of(found, found + count, [&](const pong_detection &other) {
		return std::hypot(other.u - ball.u, other.v - ball.v) < std::max(other.size, ball.size) / 2;
	});
}

// Puts a detection among found[count], best contrast first, or in the place of a worse one. Returns the new count.
inline int insert_detection(const pong_detection &detection, pong_detection *found, int count, int capacity)
{
	if (count < capacity)
		found[count++] = detection;
	else if (found[count - 1].contrast < detection.contrast)
		found[count - 1] = detection;
	std::sort(found, found + count,
		  [](const pong_detection &a, const pong_detection &b) { return a.contrast > b.contrast; });
	return count;
}

} // namespace pong
