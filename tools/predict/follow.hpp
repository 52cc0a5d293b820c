// One flight's points through the library: track and predict.
#pragma once

#include "owned.hpp"

namespace predict
{

class Follower
{
public:
	Follower(const pong_rig &rig, const pong_settings &settings);

	// Forget the flight and begin afresh.
	void begin();

	// Take the next point. Where it has no covariance, `noise` is its standard deviation (m); 0: the library finds
	// out.
	void push(const pong_point &point, double noise);

	// The state after the last point; false as long as there are too few.
	bool state(pong_state *state) const;
	// The prediction from it.
	bool predict(pong_prediction *prediction) const;
	// Where the ball is expected at a time no earlier than the last point's.
	bool expect(int64_t utime, pong_state *expected) const;

	int count() const;

private:
	pong_rig rig_;
	pong_settings settings_;
	pong::OwnedTrack track_;
	int64_t last_utime_ = 0;
};

} // namespace predict
