// The stages joined: push a stereo pair, get ball and prediction.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#include "camera.hpp"
#include "error.hpp"
#include "region.hpp"

namespace pong
{

namespace
{

const int balls_capacity = 16; // places in one picture that look like a ball
const double nan = std::numeric_limits<double>::quiet_NaN();

// Lets a unique_ptr own what a _new of the public header made.
template<auto free> struct Deleter {
	template<class Object> void operator()(Object *object) const
	{
		free(object);
	}
};

using Region = std::unique_ptr<pong_region, Deleter<pong_region_free>>;
using Detector = std::unique_ptr<pong_detector, Deleter<pong_detector_free>>;
using Track = std::unique_ptr<pong_track, Deleter<pong_track_free>>;

// The last pictures of one camera, copied: what a new one is compared with.
class PictureRing
{
public:
	PictureRing(int width, int height, int length)
		: width_(width), height_(height),
		  pixels_(static_cast<size_t>(length), std::vector<uint8_t>(static_cast<size_t>(width) * height))
	{
	}

	bool empty() const
	{
		return count_ == 0;
	}

	// The one that was added `age` pictures ago, or the oldest.
	pong_image earlier(size_t age) const
	{
		const uint8_t *pixels = pixels_[(count_ - std::min(age, count_)) % pixels_.size()].data();
		return {pixels, width_, height_, width_};
	}

	void add(const pong_image &image)
	{
		uint8_t *copy = pixels_[count_++ % pixels_.size()].data();
		for (int v = 0; v < height_; v++)
			memcpy(copy + static_cast<size_t>(v) * width_, image.pixels + v * image.stride,
			       static_cast<size_t>(width_));
	}

private:
	int width_, height_;
	std::vector<std::vector<uint8_t>> pixels_;
	size_t count_ = 0;
};

// What one camera's picture shows.
struct Balls {
	int count = 0;
	pong_centre centre[balls_capacity];
	double contrast[balls_capacity];
};

// One camera's stages, from picture to centres.
struct Side {
	pong_camera camera;
	Region region;
	Detector detector;
	PictureRing pictures;
	Balls balls;
};

Side make_side(const pong_rig &rig, pong_side side, const pong_settings &settings)
{
	pong_error error;
	const pong_camera &camera = rig.camera[side];
	Region region(pong_region_new(&rig, side, &settings, &error));
	if (!region)
		throw Fault{PONG_ERROR_VALUE, error.text};
	Detector detector(pong_detector_new(region.get(), &settings, &error));
	if (!detector)
		throw Fault{PONG_ERROR_MEMORY, error.text};
	return {camera,
		std::move(region),
		std::move(detector),
		PictureRing(camera.width, camera.height, 2 * settings.detect.gap),
		{}};
}

// Where the ball that is followed must be now: in which window, and how far its picture moves during the exposure.
struct Expectation {
	const pong_window *window; // null: anywhere
	const double *streak;      // null: unknown
};

void look(Side &side, const pong_image &image, const Expectation &expected, const pong_settings &settings)
{
	side.balls.count = 0;
	if (side.pictures.empty())
		return;
	pong_detection found[balls_capacity];
	const size_t gap = static_cast<size_t>(settings.detect.gap);
	const pong_pictures pictures = {image, {side.pictures.earlier(gap), side.pictures.earlier(2 * gap)}};
	const int count = pong_detect(side.detector.get(), &pictures, expected.window, found, balls_capacity);
	for (int i = 0; i < count; i++) {
		Balls &balls = side.balls;
		if (!pong_locate(&side.camera, &pictures, &found[i], expected.streak, &settings,
				 &balls.centre[balls.count]))
			continue;
		balls.contrast[balls.count++] = found[i].contrast;
	}
}

} // namespace

} // namespace pong

using namespace pong;

struct pong_eye {
	pong_rig rig;
	pong_settings settings;
	Side side[2];
	Track track;
	bool begun;
	int64_t last_utime;
};

namespace pong
{

namespace
{

// Two centres that are one ball.
struct Match {
	const pong_centre *left, *right;
	pong_point point;
};

// Where the ball that is followed must be now.
bool expected_position(const pong_eye &eye, int64_t utime, pong_state *expected)
{
	pong_state recent;
	return pong_track_recent_state(eye.track.get(), &recent) &&
	       pong_predict_at(&eye.rig, &recent, utime, &eye.settings, expected);
}

// Of all pairs of centres that can be one ball: the nearest to where it is expected, or else the brightest.
bool match_sides(const pong_eye &eye, const pong_state *expected, Match *best)
{
	const Balls &left = eye.side[PONG_LEFT].balls, &right = eye.side[PONG_RIGHT].balls;
	double best_cost = std::numeric_limits<double>::infinity();
	for (int l = 0; l < left.count; l++)
		for (int r = 0; r < right.count; r++) {
			Match match = {&left.centre[l], &right.centre[r], {}};
			if (!pong_reconstruct(&eye.rig, match.left, match.right, &eye.settings, &match.point) ||
			    !in_flight_space(eye.rig, eye.settings, match.point.position))
				continue;
			const double cost =
				expected ? (vector_of(match.point.position) - vector_of(expected->position)).norm()
					 : -left.contrast[l] - right.contrast[r];
			if (cost < best_cost) {
				best_cost = cost;
				*best = match;
			}
		}
	return best_cost < std::numeric_limits<double>::infinity();
}

// Look into the window where the ball is expected; if it is not there, or none is expected, everywhere.
bool find_ball(pong_eye &eye, int64_t utime, const pong_image image[2], pong_sight *sight, Match *match)
{
	pong_state expected;
	pong_window window[2];
	const bool expecting = expected_position(eye, utime, &expected);
	sight->windowed =
		expecting &&
		pong_window_around(&eye.rig, PONG_LEFT, expected.position, &eye.settings, &window[PONG_LEFT]) &&
		pong_window_around(&eye.rig, PONG_RIGHT, expected.position, &eye.settings, &window[PONG_RIGHT]);
	double streak[2][3];
	bool streaked[2];
	for (int side = 0; side < 2; side++)
		streaked[side] = expecting && pong_streak(&eye.rig.camera[side], expected.position, expected.velocity,
							  eye.settings.locate.exposure, streak[side]);
	for (;;) {
		for (int side = 0; side < 2; side++) {
			look(eye.side[side], image[side],
			     {sight->windowed ? &window[side] : nullptr, streaked[side] ? streak[side] : nullptr},
			     eye.settings);
			sight->detections[side] = eye.side[side].balls.count;
		}
		if (match_sides(eye, expecting ? &expected : nullptr, match))
			return true;
		if (!sight->windowed)
			return false;
		sight->windowed = 0;
	}
}

pong_outcome outcome_without_match(const pong_sight &sight)
{
	const bool left = sight.detections[PONG_LEFT] > 0, right = sight.detections[PONG_RIGHT] > 0;
	return left && right ? PONG_MISMATCH : left || right ? PONG_ONE_EYED : PONG_NOTHING;
}

pong_ball make_ball(const pong_eye &eye, const Match &match)
{
	pong_ball ball = {};
	ball.utime = match.point.utime;
	ball.frame = match.point.frame;
	ball.track = pong_track_id(eye.track.get());
	std::copy_n(match.point.position, 3, ball.position);
	memcpy(ball.covariance, match.point.covariance, sizeof ball.covariance);
	ball.centre[PONG_LEFT] = *match.left;
	ball.centre[PONG_RIGHT] = *match.right;
	const double left_uv[2] = {match.left->u, match.left->v}, right_uv[2] = {match.right->u, match.right->v};
	ball.epipolar_distance = pong_epipolar_distance(eye.rig.camera, left_uv, right_uv);
	pong_state now;
	if (expected_position(eye, ball.utime, &now))
		std::copy_n(now.velocity, 3, ball.velocity);
	else
		std::fill_n(ball.velocity, 3, nan);
	return ball;
}

// From the state that the flight's points tell, by way of where that has the ball now.
int predict(const pong_eye &eye, int64_t utime, pong_prediction *prediction)
{
	pong_state state, now;
	return pong_track_state(eye.track.get(), &state) &&
	       pong_predict_at(&eye.rig, &state, utime, &eye.settings, &now) &&
	       pong_predict(&eye.rig, &now, &eye.settings, prediction);
}

void follow_ball(pong_eye &eye, const Match &match, pong_sight *sight)
{
	if (pong_track_push(eye.track.get(), &match.point) == PONG_TRACK_REJECTED) {
		sight->outcome = PONG_REJECTED;
		return;
	}
	sight->outcome = PONG_SEEN;
	sight->has_ball = 1;
	sight->ball = make_ball(eye, match);
	sight->observations = pong_track_count(eye.track.get());
	sight->has_prediction = predict(eye, match.point.utime, &sight->prediction);
}

void check_size(const pong_camera &camera, const pong_image &image, const char *name)
{
	if (image.width != camera.width || image.height != camera.height)
		throw Fault{PONG_ERROR_VALUE, sentence("the %s picture is %d x %d, its camera in the rig %d x %d", name,
						       image.width, image.height, camera.width, camera.height)};
}

int push(pong_eye &eye, int64_t utime, int64_t frame, const pong_image image[2], pong_sight *sight)
{
	check_size(eye.rig.camera[PONG_LEFT], image[PONG_LEFT], "left");
	check_size(eye.rig.camera[PONG_RIGHT], image[PONG_RIGHT], "right");
	if (eye.begun && utime <= eye.last_utime) {
		sight->outcome = PONG_OUT_OF_ORDER;
		return PONG_NONE;
	}
	eye.begun = true;
	eye.last_utime = utime;
	pong_track_miss(eye.track.get(), utime);

	Match match;
	if (find_ball(eye, utime, image, sight, &match)) {
		match.point.utime = utime;
		match.point.frame = frame;
		follow_ball(eye, match, sight);
	} else {
		sight->outcome = outcome_without_match(*sight);
	}
	for (int side = 0; side < 2; side++)
		eye.side[side].pictures.add(image[side]);
	return sight->has_ball ? PONG_FOUND : PONG_NONE;
}

pong_eye *make_eye(const pong_rig &rig, const pong_settings &settings)
{
	pong_error error;
	Track track(pong_track_new(&rig, &settings, &error));
	if (!track)
		throw Fault{PONG_ERROR_MEMORY, error.text};
	return new pong_eye{rig,
			    settings,
			    {make_side(rig, PONG_LEFT, settings), make_side(rig, PONG_RIGHT, settings)},
			    std::move(track),
			    false,
			    0};
}

} // namespace

} // namespace pong

pong_eye *pong_eye_new(const pong_rig *rig, const pong_settings *settings, pong_error *error)
{
	return guarded_new(error, [&] { return make_eye(*rig, *settings); });
}

void pong_eye_free(pong_eye *eye)
{
	delete eye;
}

int pong_eye_push(pong_eye *eye, int64_t utime, int64_t frame, const pong_image *left, const pong_image *right,
		  pong_sight *sight, pong_error *error)
{
	memset(sight, 0, sizeof *sight);
	const pong_image image[2] = {*left, *right};
	return guarded(error, [&] { return push(*eye, utime, frame, image, sight); });
}
