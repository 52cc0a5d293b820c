#include "flight.hpp"

#include <cmath>

namespace pong
{

namespace
{

const double standard_gravity = 9.80665; // m/s^2

}

FlightModel::FlightModel(const pong_rig &rig)
	: table_(rig.table), radius_(rig.ball.diameter / 2), bounce_(vector_of(rig.ball.bounce))
{
	const pong_ball_spec &ball = rig.ball;
	const double section = M_PI * radius_ * radius_;
	const double volume = 4.0 / 3 * M_PI * radius_ * radius_ * radius_;
	drag_per_metre_ = ball.drag * ball.air_density * section / (2 * ball.mass); // k of eq. 18
	gravity_ = standard_gravity * (1 - ball.air_density * volume / ball.mass);  // g' of eq. 19: buoyancy, eq. 17
}

Vector3 FlightModel::acceleration(const Vector3 &velocity) const
{
	return -drag_per_metre_ * velocity.norm() * velocity - Vector3(0, gravity_, 0);
}

Flight FlightModel::step(const Flight &flight, double duration) const
{
	return {flight.time + duration, flight.position + duration * flight.velocity,
		flight.velocity + duration * acceleration(flight.velocity)};
}

bool FlightModel::over_table(const Vector3 &position) const
{
	return table_.present && std::abs(position.x()) <= table_.width / 2 && position.z() >= 0 &&
	       position.z() <= table_.length;
}

bool FlightModel::step_and_bounce(Flight &flight, double duration, Flight *bounce) const
{
	const Flight next = step(flight, duration);
	const bool meets = next.position.y() < radius_ && next.velocity.y() < 0 && flight.position.y() >= radius_;
	if (!meets || !over_table(next.position)) {
		flight = next;
		return false;
	}
	const double until = duration * (flight.position.y() - radius_) / (flight.position.y() - next.position.y());
	*bounce = step(flight, until);
	Flight rebound = *bounce;
	rebound.position.y() = radius_;
	rebound.velocity = bounce_.cwiseProduct(bounce->velocity);
	flight = step(rebound, duration - until);
	return true;
}

} // namespace pong
