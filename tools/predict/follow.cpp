#include "follow.hpp"

#include <algorithm>

#include "program.hpp"

namespace predict
{

Follower::Follower(const pong_rig &rig, const pong_settings &settings) : rig_(rig), settings_(settings)
{
	begin();
}

void Follower::begin()
{
	pong_error error;
	track_.reset(pong_track_new(&rig_, &settings_, &error));
	if (!track_)
		throw pong::Failure(error.text);
}

void Follower::push(const pong_point &point, double noise)
{
	pong_point known = point;
	if (known.covariance[0][0] == 0)
		for (int axis = 0; axis < 3; axis++)
			known.covariance[axis][axis] = noise * noise;
	last_utime_ = point.utime;
	pong_track_push(track_.get(), &known);
}

bool Follower::state(pong_state *state) const
{
	return pong_track_state(track_.get(), state) == PONG_FOUND;
}

// The paper's state is that of the middle of its points: carried to the last point before it is flown on from.
bool Follower::predict(pong_prediction *prediction) const
{
	pong_state last, now;
	return state(&last) &&
	       pong_predict_at(&rig_, &last, std::max(last_utime_, last.utime), &settings_, &now) == PONG_FOUND &&
	       pong_predict(&rig_, &now, &settings_, prediction) == PONG_FOUND;
}

bool Follower::expect(int64_t utime, pong_state *expected) const
{
	pong_state last;
	return state(&last) && pong_predict_at(&rig_, &last, utime, &settings_, expected) == PONG_FOUND;
}

int Follower::count() const
{
	return pong_track_count(track_.get());
}

} // namespace predict
