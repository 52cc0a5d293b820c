#include "trajectory.hpp"

#include <algorithm>
#include <cmath>

namespace pong
{

namespace
{

const int bounces_most = 8; // a ball that has bounced so often rolls: it is of no more use

}

// Of the two ends' positions and velocities in a position between them: Hermite's cubic.
struct Trajectory::Weights {
	double begin, begin_velocity, end, end_velocity;
};

Trajectory::Trajectory(const Physics &physics, const pong_table &table, const Parameters &parameters,
		       const ParameterMatrix *covariance)
	: physics_(physics), table_(table), parameters_(parameters), covariance_(covariance),
	  begin_(motion_at_anchor(parameters)), end_(begin_)
{
}

void Trajectory::advance(double latest)
{
	begin_ = end_;
	if (ends_on_table_) {
		physics_.bounce(parameters_, covariance_, begin_, scatter_);
		begin_.position.y() = physics_.contact_height(parameters_);
		bounces_++;
	}
	ends_on_table_ = false;
	end_ = begin_;
	const double duration = std::min(physics_.step_length(parameters_, begin_), latest - begin_.time);
	physics_.step(parameters_, duration, end_);
	const double contact = physics_.contact_height(parameters_);
	if (table_.present && begin_.position.y() >= contact && end_.position.y() < contact && bounces_ < bounces_most)
		end_at_contact();
}

void Trajectory::end_at_contact()
{
	const double time = time_at(1, physics_.contact_height(parameters_));
	if (!over_table(position(time)))
		return;
	const Motion contact = motion(time);
	if (contact.velocity.y() >= 0)
		return; // it lies on the table already
	end_ = contact;
	ends_on_table_ = true;
}

bool Trajectory::over_table(const Vector3 &position) const
{
	return std::abs(position.x()) <= table_.width / 2 && position.z() >= 0 && position.z() <= table_.length;
}

Trajectory::Weights Trajectory::weights(double time) const
{
	const double h = end_.time - begin_.time, s = h > 0 ? (time - begin_.time) / h : 1;
	const double s2 = s * s, s3 = s2 * s;
	return {2 * s3 - 3 * s2 + 1, h * (s3 - 2 * s2 + s), 3 * s2 - 2 * s3, h * (s3 - s2)};
}

Vector3 Trajectory::position(double time) const
{
	const Weights w = weights(time);
	return w.begin * begin_.position + w.begin_velocity * begin_.velocity + w.end * end_.position +
	       w.end_velocity * end_.velocity;
}

Rates Trajectory::position_rates(double time) const
{
	const Weights w = weights(time);
	return w.begin * begin_.position_rates + w.begin_velocity * begin_.velocity_rates +
	       w.end * end_.position_rates + w.end_velocity * end_.velocity_rates;
}

Motion Trajectory::motion(double time) const
{
	Motion between = begin_;
	physics_.step(parameters_, time - begin_.time, between);
	return between;
}

// Bisection first, for safety, then straight lines.
double Trajectory::time_at(int axis, double value) const
{
	double low = begin_.time, high = end_.time;
	for (int i = 0; i < 40 && high - low > 1e-12; i++) {
		const double above = position(low)[axis] - value, below = position(high)[axis] - value;
		const double line = low + (high - low) * above / (above - below);
		const double middle = i % 3 == 2 || !std::isfinite(line) ? (low + high) / 2 : line;
		const double here = position(middle)[axis] - value;
		if (std::abs(here) < 1e-10)
			return middle;
		(here > 0 ? low : high) = middle;
	}
	return (low + high) / 2;
}

} // namespace pong
