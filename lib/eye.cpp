// The stages joined: push a stereo pair, get ball and prediction.
#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>

#include "camera.hpp"
#include "error.hpp"
#include "estimate.hpp"
#include "expect.hpp"
#include "match.hpp"
#include "side.hpp"
#include "track.hpp"
#include "trust.hpp"

namespace pong
{

namespace
{

const double nan = std::numeric_limits<double>::quiet_NaN();

using Track = std::unique_ptr<pong_track, Deleter<pong_track_free>>;

} // namespace

} // namespace pong

using namespace pong;

struct pong_eye {
	pong_rig rig;
	pong_settings settings;
	Side side[2];
	Track track;
	bool begun;
	int64_t utime; // of the pair that is looked at

	// What the track makes expect of that pair: set before the two looks, which only read it.
	FollowedFlight flight;
	Expectation side_expected[2];
};

namespace pong
{

namespace
{

// Both have looked into the window where the ball is expected; if it is not there, they look everywhere.
bool find_ball(pong_eye &eye, pong_sight *sight, Match *match)
{
	Matcher matcher(eye.rig, eye.settings, eye.flight, eye.side);
	sight->windowed = eye.side_expected[PONG_LEFT].windowed;
	for (;;) {
		for (int side = 0; side < 2; side++)
			sight->detections[side] = eye.side[side].count();
		if (matcher.match_sides(sight->windowed, match))
			return true;
		if (!sight->windowed)
			return false;
		sight->windowed = 0;
		for (int side = 0; side < 2; side++) {
			eye.side_expected[side].windowed = false;
			eye.side[side].look(eye.side_expected[side]);
		}
	}
}

// A picture that was refused is none of the pair.
bool has_both_pictures(const pong_eye &eye)
{
	return eye.side[PONG_LEFT].has_picture() && eye.side[PONG_RIGHT].has_picture();
}

pong_outcome outcome_without_match(const pong_sight &sight)
{
	const bool left = sight.detections[PONG_LEFT] > 0, right = sight.detections[PONG_RIGHT] > 0;
	return left && right ? PONG_MISMATCH : left || right ? PONG_ONE_EYED : PONG_NOTHING;
}

// Of the flight, this point included. The fit to all of its points is not waited for where what was expected tells as
// much.
Vector3 velocity_of(pong_eye &eye, const Match &match, pong_track_event event)
{
	if (event == PONG_TRACK_FOLLOWED && eye.flight.expecting && eye.flight.expected.has_spin)
		return velocity_given(eye.flight.expected, match.point);
	settle(*eye.track);
	pong_state now;
	return expected_state(eye.rig, *eye.track, match.point.utime, eye.settings, &now) ? vector_of(now.velocity)
											  : Vector3::Constant(nan);
}

pong_ball make_ball(pong_eye &eye, const Match &match, pong_track_event event)
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
	store(velocity_of(eye, match, event), ball.velocity);
	return ball;
}

// From the state that the flight's points tell, by way of where that has the ball now.
int predict(pong_eye &eye, int64_t utime, pong_prediction *prediction)
{
	settle(*eye.track);
	pong_state state, now;
	return pong_track_state(eye.track.get(), &state) &&
	       pong_predict_at(&eye.rig, &state, utime, &eye.settings, &now) &&
	       pong_predict(&eye.rig, &now, &eye.settings, prediction);
}

void follow_ball(pong_eye &eye, Match match, pong_sight *sight)
{
	const Trust trust = trust_of(match, eye.side, eye.settings);
	if (cluttered(eye.side))
		match.point = doubted(match);
	const bool believed =
		!is_hopeless(match, trust, eye.flight) && !is_hardly_known(match.point, trust, eye.settings);
	const pong_track_event event = believed ? push_point(*eye.track, match.point, trust) : PONG_TRACK_REJECTED;
	if (event == PONG_TRACK_REJECTED) {
		sight->outcome = PONG_REJECTED;
		return;
	}
	count_point(match, event, &eye.flight);
	sight->outcome = PONG_SEEN;
	sight->has_ball = 1;
	sight->ball = make_ball(eye, match, event);
	sight->observations = pong_track_count(eye.track.get());
}

void check_size(const pong_eye &eye, pong_side side, const pong_image &image)
{
	const pong_camera &camera = eye.rig.camera[side];
	if (image.width != camera.width || image.height != camera.height)
		throw Fault{PONG_ERROR_VALUE, sentence("the %s picture is %d x %d, its camera in the rig %d x %d",
						       side == PONG_LEFT ? "left" : "right", image.width, image.height,
						       camera.width, camera.height)};
}

int look(pong_eye &eye, pong_side side, const pong_image &image)
{
	check_size(eye, side, image);
	eye.side[side].add(image);
	eye.side[side].look(eye.side_expected[side]);
	return eye.side[side].count();
}

pong_eye *make_eye(const pong_rig &rig, const pong_settings &settings)
{
	pong_error error;
	Track track(pong_track_new(&rig, &settings, &error));
	if (!track)
		throw Fault{PONG_ERROR_MEMORY, error.text};
	Expectation expectation = {};
	expectation.exposure = settings.locate.exposure;
	return new pong_eye{rig,
			    settings,
			    {Side(rig, PONG_LEFT, settings), Side(rig, PONG_RIGHT, settings)},
			    std::move(track),
			    false,
			    0,
			    {},
			    {expectation, expectation}};
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

void pong_eye_set_exposure(pong_eye *eye, pong_side side, double exposure)
{
	const double longest = 0.1; // s; in more no streak is one
	if (eye->settings.locate.exposure == 0)
		eye->side_expected[side].exposure = exposure > 0 && exposure <= longest ? exposure : 0;
}

int pong_eye_expect(pong_eye *eye, int64_t utime)
{
	if (eye->begun && utime <= eye->utime)
		return PONG_NONE;
	eye->begun = true;
	eye->utime = utime;
	for (Side &side : eye->side)
		side.forget();
	settle(*eye->track);
	pong_track_miss(eye->track.get(), utime);
	look_ahead(eye->rig, *eye->track, utime, eye->settings, &eye->flight);
	expect(eye->rig, eye->settings, eye->flight, cluttered(eye->side), eye->side_expected);
	return PONG_FOUND;
}

int pong_eye_look(pong_eye *eye, pong_side side, const pong_image *image, pong_error *error)
{
	return guarded(error, [&] { return look(*eye, side, *image); });
}

int pong_eye_join(pong_eye *eye, int64_t frame, pong_sight *sight)
{
	memset(sight, 0, sizeof *sight);
	Match match;
	if (has_both_pictures(*eye) && find_ball(*eye, sight, &match)) {
		match.point.utime = eye->utime;
		match.point.frame = frame;
		follow_ball(*eye, match, sight);
	} else {
		sight->outcome = outcome_without_match(*sight);
	}
	return sight->has_ball ? PONG_FOUND : PONG_NONE;
}

int pong_eye_predict(pong_eye *eye, pong_sight *sight)
{
	sight->has_prediction = sight->has_ball && predict(*eye, sight->ball.utime, &sight->prediction);
	return sight->has_prediction ? PONG_FOUND : PONG_NONE;
}

void pong_eye_keep(pong_eye *eye)
{
	for (Side &side : eye->side)
		side.keep();
}

int pong_eye_push(pong_eye *eye, int64_t utime, int64_t frame, const pong_image *left, const pong_image *right,
		  pong_sight *sight, pong_error *error)
{
	memset(sight, 0, sizeof *sight);
	return guarded(error, [&] {
		check_size(*eye, PONG_LEFT, *left);
		check_size(*eye, PONG_RIGHT, *right);
		if (!pong_eye_expect(eye, utime)) {
			sight->outcome = PONG_OUT_OF_ORDER;
			return static_cast<int>(PONG_NONE);
		}
		look(*eye, PONG_LEFT, *left);
		look(*eye, PONG_RIGHT, *right);
		const int seen = pong_eye_join(eye, frame, sight);
		pong_eye_predict(eye, sight);
		pong_eye_keep(eye);
		return seen;
	});
}
