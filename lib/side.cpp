#include "side.hpp"

#include <algorithm>
#include <cmath>

#include "detector.hpp"
#include "error.hpp"
#include "fresh.hpp"
#include "outline.hpp"

namespace pong
{

namespace
{

const double faint = 12;        // a ball of less contrast has no edges that can be located, grey levels
const double faint_error = 0.1; // of its centre then, radii
const double usual_noise = 2;   // of a pixel, standard deviation, grey levels
const int located_at_once = 2;  // more are only located where the other camera sees something that agrees

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

} // namespace

Side::Side(const pong_rig &rig, pong_side side, const pong_settings &settings)
	: camera_(rig.camera[side]), settings_(settings), region_(make_region(rig, side, settings)),
	  detector_(make_detector(region_.get(), settings)),
	  pictures_(camera_.width, camera_.height, 2 * settings.detect.gap + 1)
{
}

void Side::add(const pong_image &image)
{
	pictures_.add(image);
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
			balls_capacity);
	std::fill_n(known_, count_, unknown);
	if (count_ <= located_at_once || settings_.detect.method == PONG_DETECT_DIFFERENCE)
		locate_all();
}

void Side::locate_all()
{
	int kept = 0;
	for (int i = 0; i < count_; i++) {
		if (!ball(i))
			continue;
		found_[kept] = found_[i];
		balls_[kept] = balls_[i];
		known_[kept++] = ball_there;
	}
	count_ = kept;
}

// The centre on the original picture. Of a faint ball the noise leaves no edges that are to be trusted: there the
// detection's own centre stands.
bool Side::locate(const pong_detection &found, pong_centre *centre) const
{
	const pong_pictures pictures = compared();
	if (settings_.detect.method == PONG_DETECT_DIFFERENCE || found.contrast >= faint)
		return pong_locate(&camera_, &pictures, &found, expected_.streaked ? expected_.streak : nullptr,
				   &settings_, centre);
	const double variance = std::pow(faint_error * found.size / 2, 2);
	*centre = {};
	centre->u = found.u;
	centre->v = found.v;
	centre->radius = found.size / 2;
	centre->covariance[0][0] = centre->covariance[1][1] = variance;
	return true;
}

const Side::Ball *Side::ball(int i)
{
	pong_centre &centre = balls_[i].centre;
	if (known_[i] == unknown) {
		known_[i] = locate(found_[i], &centre) ? ball_there : no_ball;
		if (known_[i] == ball_there)
			balls_[i].shown =
				measure_outline(pictures_.earlier(0), centre.u, centre.v, centre.radius, usual_noise)
					.shown;
	}
	return known_[i] == ball_there ? &balls_[i] : nullptr;
}

bool Side::cluttered() const
{
	return pong::cluttered(*detector_);
}

double Side::freshness(const pong_centre &centre) const
{
	const pong_image now = pictures_.earlier(0), previous = pictures_.earlier(1);
	return pong::freshness(now, previous, gain_between(now, previous), centre.u, centre.v, centre.radius);
}

} // namespace pong
