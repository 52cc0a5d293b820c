// One camera's stages, from picture to centres.
#pragma once

#include <memory>

#include "outline.hpp"
#include "picture_ring.hpp"
#include "pongeye.h"

namespace pong
{

// Lets a unique_ptr own what a _new of the public header made.
template<auto free> struct Deleter {
	template<class Object> void operator()(Object *object) const
	{
		free(object);
	}
};

// Where the ball that is followed must be now in one camera's picture, and how far it moves there during the exposure.
struct Expectation {
	bool windowed, streaked; // whether what follows is known
	pong_window window;
	double streak[3];
	bool seen_once; // before: there, so many seconds ago
	double position[3], seconds;
};

class Side
{
public:
	static const int places_capacity = 16; // in one picture that look like a ball

	Side(const pong_rig &rig, pong_side side, const pong_settings &settings);

	// The picture is the caller's until keep() copies it.
	void add(const pong_image &image)
	{
		pictures_.add(image);
	}
	void keep();
	void forget()
	{
		pictures_.forget();
	}

	// Whether the pair that is looked at has its picture.
	bool has_picture() const
	{
		return pictures_.has_newest();
	}

	// Look at the newest picture.
	void look(const Expectation &expected);

	// Places that look like a ball.
	int count() const
	{
		return count_;
	}
	const pong_detection &found(int i) const
	{
		return found_[i];
	}

	// Where the ball's centre is, and how much of its outline shows; null where the pixels are no ball's. Worked
	// out when first asked for.
	struct Ball {
		pong_centre centre;
		double shown;
		bool guided; // the centre is only where the other camera tells that it must be
	};
	const Ball *ball(int i);
	bool is_located(int i) const
	{
		return known_[i] == ball_there;
	}

	// Look at one more place, about where a ball of this size is expected.
	void look_near(double u, double v, double size);

	// Look at a place where the picture shows the outline of a ball that the other camera sees.
	void look_at(const pong_detection &place);

	// How much of a ball's outline shows there.
	Outline outline(double u, double v, double radius) const;

	// Whether something else moves where was looked.
	bool cluttered() const;

	// How much what is seen there differs from all that was near it in the picture before, grey levels.
	double freshness(double u, double v, double radius) const;

private:
	void locate_all();
	void add_moved();
	bool is_in_picture(const pong_detection &place) const;
	bool add_place(const pong_detection &place, bool before_moved);
	bool locate(const pong_detection &found, bool before_moved, pong_centre *centre) const;
	bool streak_of(const pong_detection &found, double streak[3]) const;
	pong_pictures compared() const;
	pong_pictures moved_around(const pong_detection &found) const;

	const pong_camera camera_;
	const pong_settings settings_;
	std::unique_ptr<pong_region, Deleter<pong_region_free>> region_;
	std::unique_ptr<pong_detector, Deleter<pong_detector_free>> detector_;
	PictureRing pictures_;
	Expectation expected_ = {};
	int count_ = 0;
	static const int balls_capacity = 3 * places_capacity; // before one background and another, and looked near
	pong_detection found_[balls_capacity];
	bool before_moved_[balls_capacity];
	Ball balls_[balls_capacity];
	enum { unknown, ball_there, no_ball } known_[balls_capacity];
};

// Whether something that is no ball moved, where either camera has last looked.
inline bool cluttered(const Side side[2])
{
	return side[PONG_LEFT].cluttered() || side[PONG_RIGHT].cluttered();
}

} // namespace pong
