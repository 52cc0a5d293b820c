#include "halves.hpp"

#include <algorithm>
#include <cmath>

#include "camera.hpp"

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
	pong_state state = {};
	state.utime = points[begin].utime + std::llround(1e6 * (x_time + z_time) / 2);
	store((x.position + z.position) / 2, state.position);
	store((z.position - x.position) / (z_time - x_time), state.velocity);
	return state;
}

} // namespace

Halves::Halves()
{
	points_.reserve(points_capacity);
}

void Halves::clear()
{
	points_.clear();
	since_bounce_ = before_bounce_ = 0;
}

void Halves::add(const pong_point &point, const pong_rig &rig)
{
	if (points_.size() == points_capacity)
		forget_half();
	if (has_bounced(point, rig)) {
		before_bounce_ = since_bounce_;
		since_bounce_ = points_.size();
	}
	points_.push_back(point);
}

bool Halves::state(pong_state *state) const
{
	return state_of_latest(points_capacity, state);
}

bool Halves::recent_state(pong_state *state) const
{
	return state_of_latest(recent_count, state);
}

bool Halves::state_of_latest(size_t most, pong_state *state) const
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

void Halves::forget_half()
{
	const size_t half = points_capacity / 2;
	points_.erase(points_.begin(), points_.begin() + half);
	since_bounce_ -= std::min(since_bounce_, half);
	before_bounce_ -= std::min(before_bounce_, half);
}

// Whether the ball has bounced before this point: without a bounce it would be below the table.
bool Halves::has_bounced(const pong_point &point, const pong_rig &rig) const
{
	pong_state recent;
	if (!rig.table.present || !recent_state(&recent) || recent.velocity[1] > 0)
		return false;
	const double time = seconds(recent.utime, point.utime);
	const double gravity = 9.8;
	const double height = recent.position[1] + time * recent.velocity[1] - gravity / 2 * time * time;
	return height < rig.ball.diameter / 2 && point.position[1] > height + bounce_margin;
}

} // namespace pong
