// A flight marched through: stretch by stretch, with a bounce wherever it meets the table.
#pragma once

#include "physics.hpp"

namespace pong
{

class Trajectory
{
public:
	// From the anchor on; no stretch yet.
	// With the parameters' covariance, the mean of the flights that are possible: see Physics::bounce.
	Trajectory(const Physics &physics, const pong_table &table, const Parameters &parameters,
		   const ParameterMatrix *covariance = nullptr);

	// Go on to the next stretch: as long as accuracy allows, no longer than to `latest`, and no farther than to
	// where the ball meets the table.
	void advance(double latest);

	// Both ends of the present stretch. At a bounce the next one begins where this ends, with other velocity.
	const Motion &begin() const
	{
		return begin_;
	}
	const Motion &end() const
	{
		return end_;
	}
	// Whether the present stretch ends on the table, and how often the ball has bounced before this stretch.
	bool ends_on_table() const
	{
		return ends_on_table_;
	}
	int bounces() const
	{
		return bounces_;
	}

	// Of the bounces so far, see Physics::bounce.
	const Scatter &scatter() const
	{
		return scatter_;
	}

	// In between the ends, by cubic interpolation.
	Vector3 position(double time) const;
	Rates position_rates(double time) const;
	// All of it, by a step of its own.
	Motion motion(double time) const;

	// When the coordinate, beyond `value` at the stretch's begin, has fallen to it. Only for a value that is
	// reached.
	double time_at(int axis, double value) const;

private:
	struct Weights;
	Weights weights(double time) const;
	bool over_table(const Vector3 &position) const;
	void end_at_contact();

	const Physics &physics_;
	const pong_table &table_;
	const Parameters &parameters_;
	const ParameterMatrix *covariance_;
	Scatter scatter_ = Scatter::Zero();
	Motion begin_, end_;
	bool ends_on_table_ = false;
	int bounces_ = 0;
};

} // namespace pong
