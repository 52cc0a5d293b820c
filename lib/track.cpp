// Which points belong to one flight, and the ball's state that follows from them.
//
// A point continues the flight if it lies near where the flight is expected at its time. One that does not may be
// noise, the ball struck back, or another ball: it opens a second flight beside the first, which takes over once
// further points have confirmed it.
#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "estimate.hpp"
#include "halves.hpp"
#include "track.hpp"

namespace pong
{

namespace
{

const int confirmed = 3;             // points that make a second flight believed
const int likely_confirmed = 2;      // and a first one amid what else moves, or where the flight is not sure
const double likely_gate = 0.05;     // how far from one such point the next one is, at most, m,
const double likely_speed = 20;      // and m/s
const int firm_needed = 3;           // believed points that make a flight with doubtful ones sure
const double gone = 0.1;             // a flight not seen for so long needs no such proof against it, s
const double gone_certain = 0.03;    // the same where the point is certainly a ball
const double expected_sigma = 0.015; // what no covariance knows of where a ball is expected, m
const double surprise = 25;          // squared normalised distance of a point that is not the expected ball

double seconds(int64_t from, int64_t to)
{
	return static_cast<double>(to - from) * 1e-6;
}

// The flight of one ball, by the method that was chosen.
class Run
{
public:
	Run(const pong_rig &rig, const pong_settings &settings)
		: method_(settings.track.state), estimate_(rig, settings.track.noise)
	{
	}

	void clear()
	{
		count_ = firm_ = 0;
		sure_ = true;
		halves_.clear();
		estimate_.clear();
	}

	void add(const pong_point &point, const pong_rig &rig, Trust trust)
	{
		if (count_ == 0)
			first_ = point.utime;
		last_ = point;
		count_++;
		firm_ += trust != Trust::none;
		sure_ = sure_ && trust != Trust::none && trust != Trust::likely;
		if (method_ == PONG_STATE_FLIGHT)
			estimate_.add(point);
		else
			halves_.add(point, rig);
	}

	// Before the state is asked for.
	void settle()
	{
		estimate_.settle();
	}

	bool state(pong_state *state) const
	{
		return method_ == PONG_STATE_FLIGHT ? count_ > 1 && estimate_.state(state) : halves_.state(state);
	}

	bool recent_state(pong_state *recent) const
	{
		return method_ == PONG_STATE_FLIGHT ? state(recent) : halves_.recent_state(recent);
	}

	int count() const
	{
		return count_;
	}
	int firm() const // of the points, those that were believed by themselves
	{
		return firm_;
	}
	bool sure() const // whether each of its points could have begun a flight
	{
		return sure_;
	}
	int64_t first() const
	{
		return first_;
	}
	const pong_point &last() const
	{
		return last_;
	}

private:
	pong_state_method method_;
	int count_ = 0, firm_ = 0;
	bool sure_ = true;
	int64_t first_ = 0;
	pong_point last_ = {};
	Halves halves_;
	Estimate estimate_;
};

} // namespace

} // namespace pong

using namespace pong;

struct pong_track {
	pong_rig rig;
	pong_settings settings;
	Run run[2];
	Run *flight, *other; // the ball that is followed, and one that may take its place
	int32_t id;
	int32_t flights; // numbers given out
};

namespace pong
{

namespace
{

// True covariances say how far the point may lie from where it is expected; where the point has none, the gate does.
bool within_covariance(const pong_track &track, const pong_state &expected, const pong_point &point)
{
	using Covariance = Eigen::Matrix<double, PONG_STATE_SIZE, PONG_STATE_SIZE, Eigen::RowMajor>;
	const Eigen::Map<const Covariance> covariance(&expected.covariance[0][0]);
	const Eigen::Map<const Matrix3> of_point(&point.covariance[0][0]);
	const double sigma = of_point.isZero(0) ? track.settings.track.gate / 3 : expected_sigma;
	const Matrix3 spread = covariance.topLeftCorner<3, 3>() + of_point + sigma * sigma * Matrix3::Identity();
	const Vector3 distance = vector_of(point.position) - vector_of(expected.position);
	return distance.dot(spread.inverse() * distance) <= surprise;
}

// Whether the point can be the run's ball at its time.
bool fits(const pong_track &track, const Run &run, const pong_point &point)
{
	const double waited = seconds(run.last().utime, point.utime);
	if (!(waited > 0) || waited > track.settings.track.lost)
		return false;
	pong_state recent, expected;
	double reach = track.settings.track.gate + track.settings.track.gate_rate * waited;
	if (run.recent_state(&recent)) {
		if (!pong_predict_at(&track.rig, &recent, point.utime, &track.settings, &expected))
			return false;
		if (expected.has_spin)
			return within_covariance(track, expected, point);
	} else {
		std::copy_n(run.last().position, 3, expected.position);
		reach = run.sure() ? track.settings.track.gate + track.settings.track.speed * waited
				   : likely_gate + likely_speed * waited;
	}
	return (vector_of(point.position) - vector_of(expected.position)).norm() <= reach;
}

bool flies_to_robot(const Run &run)
{
	pong_state state;
	return run.recent_state(&state) && state.velocity[2] < 0;
}

// Two balls are seen where the flight has had points since the other began. The paper knows one ball only: the newest.
bool prefer_flight(const pong_track &track)
{
	return track.settings.track.state == PONG_STATE_FLIGHT && track.flight->count() > 0 &&
	       track.flight->last().utime > track.other->first() &&
	       (flies_to_robot(*track.flight) || !flies_to_robot(*track.other));
}

// How many points make a second flight believed, this one included.
int points_needed(const pong_track &track, const pong_point &point, Trust trust)
{
	const bool has_flight = track.flight->count() > 0;
	if (has_flight && trust == Trust::likely && !is_firm(track))
		return likely_confirmed;
	const double unseen = has_flight ? seconds(track.flight->last().utime, point.utime) : INFINITY;
	const bool is_gone = unseen > (trust == Trust::certain ? gone_certain : gone);
	if (trust == Trust::likely)
		return is_gone ? likely_confirmed : confirmed;
	return is_gone ? 1 : confirmed;
}

pong_track_event push_other(pong_track &track, const pong_point &point, Trust trust)
{
	Run &other = *track.other;
	if (trust == Trust::none || (other.count() > 0 && point.utime <= other.last().utime))
		return PONG_TRACK_REJECTED;
	const int needed = points_needed(track, point, trust);
	if (other.count() > 0 && (!fits(track, other, point) || (needed == 1 && !other.sure())))
		other.clear();
	other.add(point, track.rig, trust);
	other.settle();
	if (other.count() < needed || (prefer_flight(track) && (trust != Trust::likely || is_firm(track))))
		return PONG_TRACK_REJECTED;
	std::swap(track.flight, track.other);
	track.other->clear();
	track.id = ++track.flights;
	return PONG_TRACK_BEGUN;
}

// What may be something else is only believed where the ball has just been.
bool continues(const pong_track &track, const pong_point &point, Trust trust)
{
	const Run &flight = *track.flight;
	return flight.count() > 0 && (trust != Trust::none || seconds(flight.last().utime, point.utime) < gone) &&
	       fits(track, flight, point);
}

bool usable(const pong_point &point)
{
	return vector_of(point.position).allFinite() && Eigen::Map<const Matrix3>(&point.covariance[0][0]).allFinite();
}

} // namespace

bool is_firm(const pong_track &track)
{
	return track.flight->firm() >= firm_needed;
}

pong_track_event push_point(pong_track &track, const pong_point &point, Trust trust)
{
	if (!usable(point))
		return PONG_TRACK_REJECTED;
	settle(track);
	pong_track_miss(&track, point.utime);
	if (track.flight->count() > 0 && point.utime <= track.flight->last().utime)
		return PONG_TRACK_REJECTED;
	if (!continues(track, point, trust))
		return push_other(track, point, trust);
	track.flight->add(point, track.rig, trust);
	return PONG_TRACK_FOLLOWED;
}

void settle(pong_track &track)
{
	track.flight->settle();
}

} // namespace pong

pong_track *pong_track_new(const pong_rig *rig, const pong_settings *settings, pong_error *error)
{
	return guarded_new(error, [&] {
		pong_track *track = new pong_track{
			*rig, *settings, {Run(*rig, *settings), Run(*rig, *settings)}, nullptr, nullptr, 0, 0};
		track->flight = &track->run[0];
		track->other = &track->run[1];
		return track;
	});
}

void pong_track_free(pong_track *track)
{
	delete track;
}

pong_track_event pong_track_push(pong_track *track, const pong_point *point)
{
	const pong_track_event event = push_point(*track, *point, Trust::usual);
	settle(*track);
	return event;
}

void pong_track_miss(pong_track *track, int64_t utime)
{
	if (track->flight->count() == 0 || seconds(track->flight->last().utime, utime) <= track->settings.track.lost)
		return;
	track->flight->clear();
	track->other->clear();
	track->id = 0;
}

int32_t pong_track_id(const pong_track *track)
{
	return track->id;
}

int pong_track_count(const pong_track *track)
{
	return track->flight->count();
}

int pong_track_state(const pong_track *track, pong_state *state)
{
	return track->flight->state(state) ? PONG_FOUND : PONG_NONE;
}

int pong_track_recent_state(const pong_track *track, pong_state *state)
{
	return track->flight->recent_state(state) ? PONG_FOUND : PONG_NONE;
}
