#include "physics.hpp"

#include <algorithm>
#include <cmath>

namespace pong
{

namespace
{

const double standard_gravity = 9.80665; // m/s^2
const double step_error = 1e-6;          // m
const double least_step = 1e-4;          // s; no ball needs shorter ones, and nonsense must end too
const double least_speed = 1e-6;         // m/s; below this a direction has no meaning
const double least_spin = 1e-6;          // rad/s; the same
const double least_doubt = 1e-6;         // of the part of the slip; below this, it is sure which one is less
const double rolling_part = 0.4;  // of the slip that ends when a hollow sphere begins to roll: 1 / (1 + m r^2 / I)
const double spin_per_push = 1.5; // m r^2 / I, with I = 2/3 m r^2

Matrix3 cross_matrix(const Vector3 &d)
{
	Matrix3 matrix;
	matrix << 0, -d.z(), d.y(), d.z(), 0, -d.x(), -d.y(), d.x(), 0;
	return matrix;
}

} // namespace

Motion motion_at_anchor(const Parameters &parameters)
{
	Motion motion = {0,
			 parameters.segment<3>(PONG_STATE_POSITION),
			 parameters.segment<3>(PONG_STATE_VELOCITY),
			 parameters.segment<3>(PONG_STATE_SPIN),
			 Rates::Zero(),
			 Rates::Zero(),
			 Rates::Zero()};
	motion.position_rates.middleCols<3>(PONG_STATE_POSITION).setIdentity();
	motion.velocity_rates.middleCols<3>(PONG_STATE_VELOCITY).setIdentity();
	motion.spin_rates.middleCols<3>(PONG_STATE_SPIN).setIdentity();
	return motion;
}

ParameterMatrix carry(const ParameterMatrix &covariance, const Motion &motion)
{
	const int moving = PONG_STATE_DRAG, constant = parameter_count - moving;
	Eigen::Matrix<double, moving, parameter_count> rates;
	rates << motion.position_rates, motion.velocity_rates, motion.spin_rates;
	const Eigen::Matrix<double, moving, parameter_count> half = rates * covariance;
	ParameterMatrix carried;
	carried.topLeftCorner<moving, moving>().noalias() = half * rates.transpose();
	carried.topRightCorner<moving, constant>() = half.rightCols<constant>();
	carried.bottomLeftCorner<constant, moving>() = half.rightCols<constant>().transpose();
	carried.bottomRightCorner<constant, constant>() = covariance.bottomRightCorner<constant, constant>();
	return carried;
}

Physics::Physics(const pong_rig &rig) : radius_(rig.ball.diameter / 2)
{
	const pong_ball_spec &ball = rig.ball;
	const double section = M_PI * radius_ * radius_;
	const double volume = 4.0 / 3 * M_PI * radius_ * radius_ * radius_;
	drag_factor_ = ball.air_density * section / (2 * ball.mass); // of eq. 18: k = drag_factor C
	magnus_factor_ = 1 / ball.mass;
	drag_by_spin_ = drag_factor_ * ball.drag_by_spin * radius_;
	saturation_ = ball.magnus_saturation * radius_;
	gravity_ = standard_gravity * (1 - ball.air_density * volume / ball.mass); // eq. 17, 19
}

// a = -k |v| v + m q w x v - [0 g' 0]', where q = |v| / (|v| + s r |w|): a ball that spins faster than it flies drags
// less and less of the air along.
Vector3 Physics::acceleration(const Parameters &parameters, const Motion &motion) const
{
	const Vector3 &v = motion.velocity;
	const double speed = v.norm() + least_speed;
	const double q = speed / (speed + saturation_ * motion.spin.norm());
	const double k = drag_factor_ * parameters[PONG_STATE_DRAG] * speed + drag_by_spin_ * motion.spin.norm();
	return -k * v + magnus_factor_ * parameters[PONG_STATE_MAGNUS] * q * motion.spin.cross(v) -
	       Vector3(0, gravity_, 0);
}

// With a rate l at which velocity turns and fades, the next term of the series that a step drops is
// |v| l^4 h^5 / 120.
double Physics::step_length(const Parameters &parameters, const Motion &motion) const
{
	const double speed = motion.velocity.norm();
	const double rate = drag_factor_ * std::abs(parameters[PONG_STATE_DRAG]) * speed +
			    magnus_factor_ * std::abs(parameters[PONG_STATE_MAGNUS]) * motion.spin.norm() + 1;
	return std::max(least_step, std::pow(120 * step_error / ((speed + 1) * std::pow(rate, 4)), 0.2));
}

void Physics::step(const Parameters &parameters, double duration, Motion &motion) const
{
	const double part[4] = {0, 0.5 * duration, 0.5 * duration, duration};
	const double weight[4] = {duration / 6, duration / 3, duration / 3, duration / 6};
	const double k = drag_factor_ * parameters[PONG_STATE_DRAG];
	const double m = magnus_factor_ * parameters[PONG_STATE_MAGNUS];
	const double spin = motion.spin.norm() + least_spin, surface = saturation_ * spin;
	const Rates spin_part = motion.spin_rates;
	Vector3 a = Vector3::Zero(), position = motion.position, velocity = motion.velocity;
	Rates a_rates = Rates::Zero(), position_rates = motion.position_rates, velocity_rates = motion.velocity_rates;
	for (int stage = 0; stage < 4; stage++) {
		const Vector3 v = motion.velocity + part[stage] * a;
		const Rates v_rates = motion.velocity_rates + part[stage] * a_rates;
		const double speed = v.norm() + least_speed, q = speed / (speed + surface);
		const Vector3 turn = q * motion.spin.cross(v);
		const double drag = k * speed + drag_by_spin_ * spin;
		a = -drag * v + m * turn - Vector3(0, gravity_, 0);
		const Matrix3 by_velocity =
			m * q * cross_matrix(motion.spin) - drag * Matrix3::Identity() +
			(m * surface / (speed * (speed + surface)) * turn - k * v) * v.transpose() / speed;
		const Matrix3 by_spin =
			-m * q * cross_matrix(v) - (m * saturation_ / (speed + surface) * turn + drag_by_spin_ * v) *
							   motion.spin.transpose() / spin;
		a_rates.noalias() = by_velocity.lazyProduct(v_rates);
		a_rates += by_spin.lazyProduct(spin_part);
		a_rates.col(PONG_STATE_DRAG) -= drag_factor_ * speed * v;
		a_rates.col(PONG_STATE_MAGNUS) += magnus_factor_ * turn;
		position += weight[stage] * v;
		velocity += weight[stage] * a;
		position_rates += weight[stage] * v_rates;
		velocity_rates += weight[stage] * a_rates;
	}
	motion.time += duration;
	motion.position = position;
	motion.velocity = velocity;
	motion.position_rates = position_rates;
	motion.velocity_rates = velocity_rates;
}

// A ball on the table, before friction pushes it: how its lowest point slips along the table, s = v_t + w x (0, -r, 0),
// and which part of that slip friction can end by sliding, mu (1 + e) |v_y| / |s|, and which by rolling, 2/5 (1 +
// grip), of an elastic ball that is turned over (Nakashima et al. 2010; Cross 2002). With their rates.
struct Physics::Contact {
	Vector3 slip;
	Rates slip_rates;
	double sliding, rolling;
	RowRates sliding_rates, rolling_rates;
};

Physics::Contact Physics::contact(const Parameters &parameters, const Motion &motion) const
{
	const double e = parameters[PONG_STATE_RESTITUTION], mu = parameters[PONG_STATE_FRICTION];
	const double fall = -motion.velocity.y();
	Contact contact = {
		{motion.velocity.x() + radius_ * motion.spin.z(), 0, motion.velocity.z() - radius_ * motion.spin.x()},
		motion.velocity_rates,
		0,
		0,
		RowRates::Zero(),
		RowRates::Zero()};
	contact.slip_rates.row(0) += radius_ * motion.spin_rates.row(2);
	contact.slip_rates.row(1).setZero();
	contact.slip_rates.row(2) -= radius_ * motion.spin_rates.row(0);

	const double speed = std::max(contact.slip.norm(), least_speed);
	contact.sliding = mu * (1 + e) * fall / speed;
	contact.sliding_rates = -mu * (1 + e) / speed * motion.velocity_rates.row(1) -
				contact.sliding / (speed * speed) * contact.slip.transpose() * contact.slip_rates;
	contact.sliding_rates[PONG_STATE_RESTITUTION] += mu * fall / speed;
	contact.sliding_rates[PONG_STATE_FRICTION] += (1 + e) * fall / speed;
	contact.rolling = rolling_part * (1 + parameters[PONG_STATE_GRIP]);
	contact.rolling_rates[PONG_STATE_GRIP] = rolling_part;
	return contact;
}

// Which part of the slip friction ends, the lesser of both. Where it is not sure which one that is, the mean over the
// normal distribution of their difference (Clark 1961, doi:10.1287/opre.9.2.145): its rates are those of both as often
// as each is the lesser, and what the rates do not explain of its variance is left.
struct Physics::Push {
	double part;
	RowRates rates;
	double left;
};

Physics::Push Physics::push(const Contact &contact, const ParameterMatrix *covariance) const
{
	const double gap = contact.sliding - contact.rolling;
	const RowRates gap_rates = contact.sliding_rates - contact.rolling_rates;
	const double variance = covariance ? gap_rates.dot(gap_rates * *covariance) : 0.0;
	if (!(variance > least_doubt * least_doubt)) {
		return gap < 0 ? Push{contact.sliding, contact.sliding_rates, 0}
			       : Push{contact.rolling, contact.rolling_rates, 0};
	}
	const double sigma = std::sqrt(variance), score = gap / sigma;
	const double slides = 0.5 * std::erfc(score / std::sqrt(2)); // how probably
	const double density = std::exp(-0.5 * score * score) / std::sqrt(2 * M_PI);
	const double mean = gap * slides - sigma * density; // of min(gap, 0)
	const double square = (gap * gap + variance) * slides - gap * sigma * density;
	return {contact.rolling + mean, contact.rolling_rates + slides * gap_rates,
		std::max(0.0, square - mean * mean - slides * slides * variance)};
}

// dw = (r x m dv) / I
void Physics::push_along_table(const Parameters &parameters, const ParameterMatrix *covariance, Motion &motion,
			       Scatter &scatter) const
{
	const Contact contact = this->contact(parameters, motion);
	const Push push = this->push(contact, covariance);
	const Vector3 kick(parameters[PONG_STATE_KICK_X], 0, parameters[PONG_STATE_KICK_Z]);
	const Vector3 change = kick - push.part * contact.slip;
	Rates change_rates = -push.part * contact.slip_rates - contact.slip * push.rates;
	change_rates(0, PONG_STATE_KICK_X) += 1;
	change_rates(2, PONG_STATE_KICK_Z) += 1;
	const Eigen::Vector2d slip(contact.slip.x(), contact.slip.z());
	scatter += push.left * slip * slip.transpose();

	const double lever = spin_per_push / radius_, e = parameters[PONG_STATE_RESTITUTION];
	motion.velocity_rates.row(1) *= -e;
	motion.velocity_rates(1, PONG_STATE_RESTITUTION) -= motion.velocity.y();
	motion.velocity.y() *= -e;
	motion.velocity += change;
	motion.velocity_rates += change_rates;
	motion.spin += lever * Vector3(-change.z(), 0, change.x());
	motion.spin_rates.row(0) -= lever * change_rates.row(2);
	motion.spin_rates.row(2) += lever * change_rates.row(0);
}

void Physics::bounce(const Parameters &parameters, const ParameterMatrix *covariance, Motion &motion,
		     Scatter &scatter) const
{
	// y(t) = r + h defines the moment of contact t, so dt = (dh - dy) / v_y. To that moment, through the contact,
	// and back.
	RowRates moment = -motion.position_rates.row(1);
	moment[PONG_STATE_HEIGHT] += 1;
	moment /= motion.velocity.y();
	motion.position_rates += motion.velocity * moment;
	motion.velocity_rates += acceleration(parameters, motion) * moment;
	push_along_table(parameters, covariance, motion, scatter);
	motion.position_rates -= motion.velocity * moment;
	motion.velocity_rates -= acceleration(parameters, motion) * moment;
}

} // namespace pong
