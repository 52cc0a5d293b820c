// Which points belong to one flight, and the ball's state that follows from them.
//
// A point continues the flight if it lies near where the flight is expected at its time. One that does not may be
// noise, or the first of another ball: it opens a second flight beside the first, and takes over once that has been
// confirmed by a further point while the first one was not seen.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "error.hpp"
#include "flight.hpp"

namespace pong
{

namespace
{

const size_t points_capacity = 512; // of one flight: over four seconds
const size_t recent_count = 6;      // points that tell where the ball is just now
const double bounce_margin = 0.02;  // a ball this far above where it would be without a bounce has bounced, m

double seconds(int64_t from, int64_t to)
{
	return static_cast<double>(to - from) * 1e-6;
}

// Means over a run of points: half of the paper's Fig. 8.
struct Mean {
	Vector3 position;
	double time;
};

Mean mean_of(const std::vector<pong_point> &points, size_t begin, size_t end)
{
	Mean mean = {Vector3::Zero(), 0};
	for (size_t i = begin; i < end; i++) {
		mean.position += vector_of(points[i].position);
		mean.time += seconds(points[begin].utime, points[i].utime);
	}
	const double count = static_cast<double>(end - begin);
	mean.position /= count;
	mean.time /= count;
	return mean;
}

// The paper's smoothing: cut the points [begin, end) in two halves; with x and z their means, y = (x + z) / 2 is the
// position and (z - x) / (t_z - t_x) the velocity. An odd one in the middle belongs to both.
pong_state two_halves(const std::vector<pong_point> &points, size_t begin, size_t end)
{
	const size_t half = (end - begin + 1) / 2;
	const Mean x = mean_of(points, begin, begin + half), z = mean_of(points, end - half, end);
	const double x_time = x.time, z_time = z.time + seconds(points[begin].utime, points[end - half].utime);
	pong_state state = {points[begin].utime + std::llround(1e6 * (x_time + z_time) / 2), {}, {}};
	store((x.position + z.position) / 2, state.position);
	store((z.position - x.position) / (z_time - x_time), state.velocity);
	return state;
}

// The points of one ball.
class PointRun
{
public:
	PointRun()
	{
		points_.reserve(points_capacity);
	}

	void clear()
	{
		points_.clear();
		since_bounce_ = before_bounce_ = 0;
	}

	size_t size() const
	{
		return points_.size();
	}

	const pong_point &last() const
	{
		return points_.back();
	}

	void add(const pong_point &point, const pong_rig &rig)
	{
		if (points_.size() == points_capacity)
			forget_half();
		if (has_bounced(point, rig)) {
			before_bounce_ = since_bounce_;
			since_bounce_ = points_.size();
		}
		points_.push_back(point);
	}

	// From the latest `most` points of the leg since the last bounce; from the leg before it where the new one has
	// but one point yet.
	bool state(size_t most, pong_state *state) const
	{
		size_t begin = since_bounce_, end = points_.size();
		if (end - begin < 2) {
			begin = before_bounce_;
			end = since_bounce_ > 0 ? since_bounce_ : end;
		}
		if (end - begin < 2)
			return false;
		if (end - begin > most)
			begin = end - most;
		*state = two_halves(points_, begin, end);
		return true;
	}

private:
	void forget_half()
	{
		const size_t half = points_capacity / 2;
		points_.erase(points_.begin(), points_.begin() + half);
		since_bounce_ -= std::min(since_bounce_, half);
		before_bounce_ -= std::min(before_bounce_, half);
	}

	// Whether the ball has bounced before this point: without a bounce it would be below the table.
	bool has_bounced(const pong_point &point, const pong_rig &rig) const
	{
		pong_state recent;
		if (!rig.table.present || !state(recent_count, &recent) || recent.velocity[1] > 0)
			return false;
		const double time = seconds(recent.utime, point.utime);
		const double gravity = 9.8;
		const double height = recent.position[1] + time * recent.velocity[1] - gravity / 2 * time * time;
		return height < rig.ball.diameter / 2 && point.position[1] > height + bounce_margin;
	}

	std::vector<pong_point> points_;
	size_t since_bounce_ = 0, before_bounce_ = 0; // where the present leg and the one before it begin
};

} // namespace

} // namespace pong

using namespace pong;

struct pong_track {
	pong_rig rig;
	pong_settings settings;
	PointRun flight, other; // the ball that is followed, and one that may take its place
	int32_t id;
	int32_t flights; // numbers given out
};

namespace pong
{

namespace
{

// How far the point is from where the run's ball is expected at its time, over how far it may be.
bool fits(const pong_track &track, const PointRun &run, const pong_point &point)
{
	const double waited = seconds(run.last().utime, point.utime);
	if (!(waited > 0) || waited > track.settings.track.lost)
		return false;
	pong_state recent, expected;
	double reach = track.settings.track.gate + track.settings.track.gate_rate * waited;
	if (run.state(recent_count, &recent)) {
		if (!pong_predict_at(&track.rig, &recent, point.utime, &track.settings, &expected))
			return false;
	} else {
		std::copy_n(run.last().position, 3, expected.position);
		reach = track.settings.track.gate + track.settings.track.speed * waited;
	}
	return (vector_of(point.position) - vector_of(expected.position)).norm() <= reach;
}

} // namespace

} // namespace pong

pong_track *pong_track_new(const pong_rig *rig, const pong_settings *settings, pong_error *error)
{
	return guarded_new(error, [&] { return new pong_track{*rig, *settings, {}, {}, 0, 0}; });
}

void pong_track_free(pong_track *track)
{
	delete track;
}

pong_track_event pong_track_push(pong_track *track, const pong_point *point)
{
	PointRun &flight = track->flight, &other = track->other;
	pong_track_miss(track, point->utime);
	if (flight.size() == 0) {
		flight.add(*point, track->rig);
		track->id = ++track->flights;
		return PONG_TRACK_BEGUN;
	}
	if (point->utime <= flight.last().utime)
		return PONG_TRACK_REJECTED;
	if (fits(*track, flight, *point)) {
		flight.add(*point, track->rig);
		return PONG_TRACK_FOLLOWED;
	}
	if (other.size() > 0 && !fits(*track, other, *point))
		other.clear();
	other.add(*point, track->rig);
	if (other.size() < 3)
		return PONG_TRACK_REJECTED;
	std::swap(flight, other);
	other.clear();
	track->id = ++track->flights;
	return PONG_TRACK_BEGUN;
}

void pong_track_miss(pong_track *track, int64_t utime)
{
	if (track->flight.size() == 0 || seconds(track->flight.last().utime, utime) <= track->settings.track.lost)
		return;
	track->flight.clear();
	track->other.clear();
	track->id = 0;
}

int32_t pong_track_id(const pong_track *track)
{
	return track->id;
}

int pong_track_count(const pong_track *track)
{
	return static_cast<int>(track->flight.size());
}

int pong_track_state(const pong_track *track, pong_state *state)
{
	return track->flight.state(points_capacity, state) ? PONG_FOUND : PONG_NONE;
}

int pong_track_recent_state(const pong_track *track, pong_state *state)
{
	return track->flight.state(recent_count, state) ? PONG_FOUND : PONG_NONE;
}
