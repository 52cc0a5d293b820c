// The most probable flight through the points seen so far, with its covariance (docs/predict.md).
//
// Maximum a posteriori over the ball at the flight's anchor, its spin, and the coefficients of air, ball and table, by
// Gauss-Newton steps that start from the estimate before the new point. The window of points is bounded: where it is
// full, the older half is folded into the prior and the anchor moves on, so a point costs the same in a long flight.
#pragma once

#include <array>

#include "noise.hpp"
#include "trajectory.hpp"

namespace pong
{

class Estimate
{
public:
	// `shared_noise`: of points without covariance, see Noise.
	Estimate(const pong_rig &rig, double shared_noise);

	void clear();
	// Points come in the order of time. One whose covariance is zero has an unknown one.
	void add(const pong_point &point);

	// Work out what the last point tells, which takes most of the time. Adding another one does so first.
	void settle();

	// The ball at the time of the last point that was settled. False while there is none.
	bool state(pong_state *state) const;

private:
	struct Sample {
		double time; // s from the anchor
		Vector3 position;
		Matrix3 information; // inverse of the covariance
		bool unknown;        // that covariance: it is the noise's
	};
	// The quadratic that stands for the cost of some points: cost, half gradient, half curvature.
	struct Quadratic {
		double cost;
		Parameters gradient;
		ParameterMatrix information;
		bool blurred; // by a bounce that may slide or roll: the cost is no flight's own
	};

	struct Belief {
		Parameters mean;
		ParameterMatrix covariance;
	};

	void begin(const pong_point &point);
	void find_noise(const pong_point &point);
	void improve();
	Quadratic linearise(const Parameters &parameters, size_t samples, const ParameterMatrix *covariance) const;
	Quadratic prior_at(const Parameters &parameters) const;
	void find_state();
	void fold();
	void move_anchor(double time, size_t first);
	void renew_kick(Parameters &parameters, ParameterMatrix &covariance) const;
	Belief belief_at(double time, const Parameters &step, const ParameterMatrix &covariance, int *bounces) const;

	pong_rig rig_;
	Physics physics_;
	static const size_t window_ = 64;
	Noise noise_;
	std::array<Sample, window_> samples_;
	size_t count_ = 0; // in the window
	bool settled_ = true;
	bool has_state_ = false;
	int64_t anchor_ = 0;
	Parameters prior_mean_;
	ParameterMatrix prior_information_;
	Parameters parameters_;
	Quadratic quadratic_;        // about parameters_
	ParameterMatrix covariance_; // of parameters_, before the new point
	pong_state state_;
};

// The velocity that a state's prediction has after a point at its time: the linear step of that estimate, which needs
// no flight to be fitted. The point's covariance is known.
Vector3 velocity_given(const pong_state &predicted, const pong_point &point);

} // namespace pong
