// The ball's physics with spin, and how every result moves with what is not known exactly.
//
// Drag, Magnus force, buoyancy and gravity in the air; at the table a hollow sphere under friction that slides or
// rolls. docs/predict.md derives what stands here.
#pragma once

#include "camera.hpp"
#include "pongeye.h"

namespace pong
{

// What a flight depends on, in the order of PONG_STATE_...: the ball at the anchor, the flight's start or a later
// moment, then the coefficients.
const int parameter_count = PONG_STATE_SIZE;
using Parameters = Eigen::Matrix<double, parameter_count, 1>;
const int coefficient_count = parameter_count - PONG_STATE_DRAG;
using Coefficients = Eigen::Matrix<double, coefficient_count, 1>;
using ParameterMatrix = Eigen::Matrix<double, parameter_count, parameter_count>;

// How a vector moves with the parameters. Row by row: the compiler makes long loops of it.
using Rates = Eigen::Matrix<double, 3, parameter_count, Eigen::RowMajor>;

// How a number does.
using RowRates = Eigen::Matrix<double, 1, parameter_count>;

// A ball on its way and how it moves with the parameters; time runs in seconds from the anchor.
struct Motion {
	double time;
	Vector3 position, velocity, spin;
	Rates position_rates, velocity_rates, spin_rates;
};

// What a bounce leaves to chance beside what its rates say: the covariance of the push along the table, x and z.
using Scatter = Eigen::Matrix2d;

// A ball at the anchor.
Motion motion_at_anchor(const Parameters &parameters);

// The covariance of the ball in motion and of the coefficients, from that of the parameters.
ParameterMatrix carry(const ParameterMatrix &covariance, const Motion &motion);

class Physics
{
public:
	explicit Physics(const pong_rig &rig);

	Vector3 acceleration(const Parameters &parameters, const Motion &motion) const;

	// The longest step that keeps the error of one Runge-Kutta step below about a micrometre.
	double step_length(const Parameters &parameters, const Motion &motion) const;

	// One Runge-Kutta step of fourth order, of the motion and its rates together.
	void step(const Parameters &parameters, double duration, Motion &motion) const;

	// A ball that touches the table, from the moment before to the moment after. The moment itself depends on the
	// parameters too: a ball that comes later bounces later. With the parameters' covariance, it is the mean of
	// the bounces that are possible, of which some slide and some roll, and their scatter is added to `scatter`.
	void bounce(const Parameters &parameters, const ParameterMatrix *covariance, Motion &motion,
		    Scatter &scatter) const;

	double radius() const
	{
		return radius_;
	}

	// Of the centre of a ball that touches the table.
	double contact_height(const Parameters &parameters) const
	{
		return radius_ + parameters[PONG_STATE_HEIGHT];
	}

private:
	struct Contact;
	struct Push;
	Contact contact(const Parameters &parameters, const Motion &motion) const;
	Push push(const Contact &contact, const ParameterMatrix *covariance) const;
	void push_along_table(const Parameters &parameters, const ParameterMatrix *covariance, Motion &motion,
			      Scatter &scatter) const;

	double radius_, drag_factor_, drag_by_spin_, magnus_factor_, saturation_, gravity_;
};

} // namespace pong
