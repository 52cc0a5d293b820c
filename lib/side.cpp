#include "side.hpp"

#include <algorithm>
#include <cmath>

#include "circles.hpp"
#include "detector.hpp"
#include "error.hpp"
#include "fresh.hpp"
#include "outline.hpp"

namespace pong
{

namespace
{

const double faint = 12;          // a ball of less contrast has no edges that can be located, grey levels
const double faint_error = 0.1;   // of its centre then, radii
const double guided_error = 0.08; // of a centre that only its outline tells, radii
const double usual_noise = 2;     // of a pixel, standard deviation, grey levels
const double fresh_enough = 12;   // of what has just come: the picture before shows what is behind it, grey levels
const double around_ball = 12;    // what its location may look at, px
const int located_at_once = 2;    // more are only located where the other camera sees something that agrees

pong_region *make_region(const pong_rig &rig, pong_side side, const pong_settings &settings)
{
	pong_error error;
	pong_region *region = pong_region_new(&rig, side, &settings, &error);
	if (!region)
		throw Fault{PONG_ERROR_VALUE, error.text};
	return region;
}

pong_detector *make_detector(const pong_region *region, const pong_settings &settings)
{
	pong_error error;
	pong_detector *detector = pong_detector_new(region, &settings, &error);
	if (!detector)
		throw Fault{PONG_ERROR_MEMORY, error.text};
	return detector;
}

// How far beyond the picture's border the ball reaches, px.
double cut_off(const pong_detection &found, const pong_camera &camera)
{
	const double radius = found.size / 2;
	return std::max({0.0, radius - found.u, radius - found.v, found.u + radius - (camera.width - 1),
			 found.v + radius - (camera.height - 1)});
}

// The detection's own centre stands. Its error is that part of the radius, and what the border cuts off of the ball.
pong_centre centre_of(const pong_detection &found, double error, const pong_camera &camera)
{
	const double cut = cut_off(found, camera);
	pong_centre centre = {};
	centre.u = found.u;
	centre.v = found.v;
	centre.radius = found.size / 2;
	centre.covariance[0][0] = centre.covariance[1][1] = std::pow(error * centre.radius + cut, 2);
	centre.flags = cut > 0 ? PONG_CENTRE_CUT : 0;
	return centre;
}

} // namespace

Side::Side(const pong_rig &rig, pong_side side, const pong_settings &settings)
	: camera_(rig.camera[side]), settings_(settings), region_(make_region(rig, side, settings)),
	  detector_(make_detector(region_.get(), settings)),
	  pictures_(camera_.width, camera_.height, 2 * settings.detect.gap + 1)
{
}

void Side::keep()
{
	if (!pictures_.keep())
		return;
	const pong_image kept = pictures_.earlier(0);
	pong_detector_remember(detector_.get(), &kept);
}

pong_pictures Side::compared() const
{
	const size_t gap = static_cast<size_t>(settings_.detect.gap);
	return {pictures_.earlier(0), {pictures_.earlier(gap), pictures_.earlier(2 * gap)}};
}

void Side::look(const Expectation &expected)
{
	expected_ = expected;
	count_ = 0;
	if (pictures_.count() < 2)
		return;
	const pong_image previous = pictures_.earlier(1);
	count_ = detect(*detector_, compared(), &previous, expected.windowed ? &expected.window : nullptr, found_,
			places_capacity);
	std::fill_n(before_moved_, count_, false);
	if (cluttered() && !expected.windowed)
		add_moved();
	std::fill_n(known_, count_, unknown);
	if (count_ <= located_at_once || settings_.detect.method == PONG_DETECT_DIFFERENCE)
		locate_all();
}

// Amid people, what is behind a ball that has just come has moved since the earlier pictures: it may be located better
// before the previous picture, moved likewise.
void Side::add_moved()
{
	const int places = count_;
	for (int i = 0; i < places; i++)
		if (freshness(found_[i].u, found_[i].v, found_[i].size / 2) > fresh_enough)
			add_place(found_[i], true);
}

// False where there is no room for it.
bool Side::add_place(const pong_detection &place, bool before_moved)
{
	if (count_ == balls_capacity)
		return false;
	found_[count_] = place;
	before_moved_[count_] = before_moved;
	known_[count_++] = unknown;
	return true;
}

// Of a ball whose centre is beyond the border, what is seen tells too little of where it is.
bool Side::is_in_picture(const pong_detection &place) const
{
	return place.u >= 0 && place.v >= 0 && place.u <= camera_.width - 1 && place.v <= camera_.height - 1;
}

void Side::look_near(double u, double v, double size)
{
	pong_detection place = {u, v, size, 0};
	if (!find_circle_near(pictures_.earlier(0), usual_noise, &place) || !is_in_picture(place))
		return;
	add_place(place, false);
	if (freshness(place.u, place.v, size / 2) > fresh_enough)
		add_place(place, true);
}

void Side::look_at(const pong_detection &place)
{
	if (!is_in_picture(place))
		return;
	// Of a faint outline nothing is located: where it was looked for would stand as if it had been found there.
	if (place.contrast >= faint) {
		add_place(place, false);
		if (freshness(place.u, place.v, place.size / 2) > fresh_enough)
			add_place(place, true);
	}
	if (!add_place(place, false))
		return;
	Ball &guided = balls_[count_ - 1];
	guided = {centre_of(place, guided_error, camera_), outline(place.u, place.v, place.size / 2).shown, true};
	known_[count_ - 1] = ball_there;
}

Outline Side::outline(double u, double v, double radius) const
{
	return measure_outline(pictures_.earlier(0), u, v, radius, usual_noise);
}

pong_pictures Side::moved_around(const pong_detection &found) const
{
	const double reach = found.size + around_ball;
	const auto begin = [&](double at) { return std::max(0, static_cast<int>(at - reach)); };
	const auto end = [&](double at, int most) { return std::min(most, static_cast<int>(at + reach) + 1); };
	const pong_image now = pictures_.earlier(0);
	const Moved moved = follow_motion(
		now, pictures_.earlier(1),
		{begin(found.u), end(found.u, camera_.width), begin(found.v), end(found.v, camera_.height)});
	return {now, {moved.image[0], moved.image[1]}};
}

void Side::locate_all()
{
	int kept = 0;
	for (int i = 0; i < count_; i++) {
		if (!ball(i))
			continue;
		found_[kept] = found_[i];
		before_moved_[kept] = before_moved_[i];
		balls_[kept] = balls_[i];
		known_[kept++] = ball_there;
	}
	count_ = kept;
}

bool Side::streak_of(const pong_detection &found, double streak[3]) const
{
	if (expected_.streaked)
		std::copy_n(expected_.streak, 3, streak);
	return expected_.streaked ||
	       (expected_.seen_once && pong_streak_since(&camera_, expected_.position, expected_.seconds, &found,
							 settings_.locate.exposure, streak));
}

// The centre on the original picture. Of a faint ball the noise leaves no edges that are to be trusted: there the
// detection's own centre stands.
bool Side::locate(const pong_detection &found, bool before_moved, pong_centre *centre) const
{
	const pong_pictures pictures = before_moved ? moved_around(found) : compared();
	double streak[3];
	if (settings_.detect.method == PONG_DETECT_DIFFERENCE || found.contrast >= faint)
		return pong_locate(&camera_, &pictures, &found, streak_of(found, streak) ? streak : nullptr, &settings_,
				   centre);
	*centre = centre_of(found, faint_error, camera_);
	return true;
}

const Side::Ball *Side::ball(int i)
{
	pong_centre &centre = balls_[i].centre;
	if (known_[i] == unknown) {
		balls_[i].guided = false;
		known_[i] = locate(found_[i], before_moved_[i], &centre) ? ball_there : no_ball;
		if (known_[i] == ball_there)
			balls_[i].shown = outline(centre.u, centre.v, centre.radius).shown;
	}
	return known_[i] == ball_there ? &balls_[i] : nullptr;
}

bool Side::cluttered() const
{
	return pong::cluttered(*detector_);
}

double Side::freshness(double u, double v, double radius) const
{
	const pong_image now = pictures_.earlier(0), previous = pictures_.earlier(1);
	return pong::freshness(now, previous, gain_between(now, previous), u, v, radius);
}

} // namespace pong
