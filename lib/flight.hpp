// How a ball flies and bounces (paper, section 6).
#pragma once

#include "camera.hpp"

namespace pong
{

// A ball on its way; time runs in seconds from any start.
struct Flight {
	double time;
	Vector3 position, velocity;
};

class FlightModel
{
public:
	explicit FlightModel(const pong_rig &rig);

	// Drag, buoyancy and gravity: a = -k |v| v - [0 g' 0]' (eq. 16 to 19).
	Vector3 acceleration(const Vector3 &velocity) const;

	// One explicit Euler step (eq. 20 to 22).
	Flight step(const Flight &flight, double duration) const;

	// The same, and the bounce where the ball meets the table (eq. 23). Returns whether it did; *bounce then is the
	// ball as it arrived there.
	bool step_and_bounce(Flight &flight, double duration, Flight *bounce) const;

private:
	bool over_table(const Vector3 &position) const;

	pong_table table_;
	double radius_, drag_per_metre_, gravity_;
	Vector3 bounce_;
};

} // namespace pong
