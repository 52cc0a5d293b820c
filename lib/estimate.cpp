#include "estimate.hpp"

#include <algorithm>
#include <cmath>

namespace pong
{

namespace
{

const size_t begin_points = 12;      // a flight so young may still need a few steps a point
const int begin_steps = 6;           // while young
const int steady_steps = 3;          // later
const double settled = 1e-2;         // a step this small, in squared standard deviations, ends the search
const double outlier = 16;           // squared normalised distance that one in a thousand good points exceeds
const size_t outlier_points = 6;     // fewer points cannot tell which of them is wrong
const double least_variance = 1e-18; // of what is certain
const double sure = 1e-5;            // m/s; a push along the table whose scatter is less is known
const double position_sigma = 10;    // m: none that matters
const Vector3 usual_velocity(0, 0.5, -6), velocity_sigma(3, 3, 6); // m/s, of play in ball-states

double square(double value)
{
	return value * value;
}

double seconds(int64_t from, int64_t to)
{
	return static_cast<double>(to - from) * 1e-6;
}

Parameters usual_parameters(const pong_rig &rig)
{
	const pong_ball_spec &ball = rig.ball;
	Parameters usual;
	usual << 0, 0, 0, usual_velocity, 0, 0, 0, ball.drag, ball.magnus, ball.restitution, ball.friction, ball.grip,
		rig.table.height, 0, 0;
	return usual;
}

Parameters usual_sigmas(const pong_rig &rig)
{
	const pong_ball_spec &ball = rig.ball;
	Parameters sigmas;
	sigmas << Vector3::Constant(position_sigma), velocity_sigma, vector_of(ball.spin_sigma), ball.drag_sigma,
		ball.magnus_sigma, ball.restitution_sigma, ball.friction_sigma, ball.grip_sigma, rig.table.height_sigma,
		ball.kick, ball.kick;
	return sigmas;
}

} // namespace

Estimate::Estimate(const pong_rig &rig, double shared_noise) : rig_(rig), physics_(rig), noise_(shared_noise)
{
	clear();
}

void Estimate::clear()
{
	count_ = 0;
	settled_ = true;
	has_state_ = false;
	noise_.clear();
	prior_mean_ = usual_parameters(rig_);
	prior_information_ =
		usual_sigmas(rig_).cwiseMax(std::sqrt(least_variance)).array().square().inverse().matrix().asDiagonal();
	covariance_.setZero();
}

void Estimate::begin(const pong_point &point)
{
	anchor_ = point.utime;
	prior_mean_.segment<3>(PONG_STATE_POSITION) = vector_of(point.position);
	parameters_ = prior_mean_;
}

void Estimate::add(const pong_point &point)
{
	settle();
	if (count_ == 0)
		begin(point);
	if (count_ == window_)
		fold();
	const Matrix3 covariance = Eigen::Map<const Matrix3>(&point.covariance[0][0]);
	const bool known = covariance.determinant() > 0;
	samples_[count_++] = {seconds(anchor_, point.utime), vector_of(point.position),
			      known ? covariance.inverse().eval() : Matrix3::Zero().eval(), !known};
	if (!known)
		find_noise(point);
	settled_ = false;
}

void Estimate::settle()
{
	if (settled_)
		return;
	improve();
	find_state();
	settled_ = has_state_ = true;
}

// A point has the noise of its own time; the first ones have what was found out from a few more.
void Estimate::find_noise(const pong_point &point)
{
	noise_.add(point.utime, vector_of(point.position));
	const Matrix3 information = noise_.sigma().array().square().inverse().matrix().asDiagonal();
	const size_t first = count_ <= 2 * Noise::reach ? 0 : count_ - Noise::reach;
	for (size_t i = first; i < count_; i++)
		if (samples_[i].unknown)
			samples_[i].information = information;
}

Estimate::Quadratic Estimate::prior_at(const Parameters &parameters) const
{
	const Parameters gradient = prior_information_ * (prior_mean_ - parameters);
	return {gradient.dot(prior_mean_ - parameters), gradient, prior_information_, false};
}

// The cost of the first samples about some parameters, with their covariance that of the mean of all flights they may
// stand for. A point far off the flight counts less, the farther the less.
Estimate::Quadratic Estimate::linearise(const Parameters &parameters, size_t samples,
					const ParameterMatrix *covariance) const
{
	Quadratic quadratic = prior_at(parameters);
	Trajectory trajectory(physics_, rig_.table, parameters, covariance);
	const double latest = samples_[samples - 1].time;
	for (size_t i = 0; i < samples; i++) {
		const Sample &sample = samples_[i];
		while (sample.time > trajectory.end().time)
			trajectory.advance(latest);
		const Vector3 residual = sample.position - trajectory.position(sample.time);
		const Rates rates = trajectory.position_rates(sample.time);
		const double distance = residual.dot(sample.information * residual);
		const double weight = samples < outlier_points || distance < outlier ? 1 : outlier / distance;
		const Matrix3 information = weight * sample.information;
		const Rates weighted = information.lazyProduct(rates);
		quadratic.cost += distance < outlier ? distance : outlier * (1 + std::log(distance / outlier));
		quadratic.gradient.noalias() += weighted.transpose() * residual;
		quadratic.information.noalias() += rates.transpose().lazyProduct(weighted);
	}
	quadratic.blurred = trajectory.scatter().trace() > sure * sure;
	return quadratic;
}

// The cost is a narrow curved valley: full steps follow it where steps that insist on a lower cost every time creep.
// The first step is that of the mean flight: a ball that is believed to roll on the table feels no friction, and one
// that in truth slides, for the table is slippery, would never be found.
void Estimate::improve()
{
	Parameters best = parameters_;
	double least = std::numeric_limits<double>::infinity();
	const int steps = count_ <= begin_points ? begin_steps : steady_steps;
	for (int i = 0; i < steps; i++) {
		quadratic_ = linearise(parameters_, count_, i == 0 ? &covariance_ : nullptr);
		if (!quadratic_.blurred && quadratic_.cost < least) {
			least = quadratic_.cost;
			best = parameters_;
		}
		const Parameters step = quadratic_.information.llt().solve(quadratic_.gradient);
		const double length = step.dot(quadratic_.gradient);
		if (!std::isfinite(length))
			break;
		parameters_ += step;
		quadratic_.gradient.setZero();
		if (!quadratic_.blurred && length < settled)
			return;
	}
	if (!(linearise(parameters_, count_, nullptr).cost < least))
		parameters_ = best;
}

// The next bounce has a kick of its own, of which the last one tells nothing.
void Estimate::renew_kick(Parameters &parameters, ParameterMatrix &covariance) const
{
	for (const int kick : {PONG_STATE_KICK_X, PONG_STATE_KICK_Z}) {
		covariance.row(kick).setZero();
		covariance.col(kick).setZero();
		covariance(kick, kick) = std::max(square(rig_.ball.kick), least_variance);
		parameters[kick] = 0;
	}
}

// The full state at a time, where the parameters are the present ones and a step, with this covariance.
Estimate::Belief Estimate::belief_at(double time, const Parameters &step, const ParameterMatrix &covariance,
				     int *bounces) const
{
	Trajectory trajectory(physics_, rig_.table, parameters_);
	while (time > trajectory.end().time)
		trajectory.advance(time);
	*bounces = trajectory.bounces();
	const Motion &motion = trajectory.end();
	Belief belief = {parameters_ + step, carry(covariance, motion)};
	belief.mean.segment<3>(PONG_STATE_POSITION) = motion.position + motion.position_rates * step;
	belief.mean.segment<3>(PONG_STATE_VELOCITY) = motion.velocity + motion.velocity_rates * step;
	belief.mean.segment<3>(PONG_STATE_SPIN) = motion.spin + motion.spin_rates * step;
	return belief;
}

void Estimate::find_state()
{
	const double time = samples_[count_ - 1].time;
	int bounces;
	covariance_ = quadratic_.information.llt().solve(ParameterMatrix::Identity());
	Belief now = belief_at(time, covariance_ * quadratic_.gradient, covariance_, &bounces);
	if (bounces > 0)
		renew_kick(now.mean, now.covariance);
	state_.utime = anchor_ + std::llround(time * 1e6);
	store(now.mean.segment<3>(PONG_STATE_POSITION), state_.position);
	store(now.mean.segment<3>(PONG_STATE_VELOCITY), state_.velocity);
	state_.has_spin = 1;
	store(now.mean.segment<3>(PONG_STATE_SPIN), state_.spin);
	std::copy_n(now.mean.data() + PONG_STATE_DRAG, PONG_STATE_SIZE - PONG_STATE_DRAG, state_.coefficients);
	Eigen::Map<ParameterMatrix>{&state_.covariance[0][0]} = now.covariance;
}

bool Estimate::state(pong_state *state) const
{
	if (!has_state_)
		return false;
	*state = state_;
	return true;
}

// The older half's cost, a quadratic about the present estimate, becomes the prior of the ball at the first of the
// newer points: the new anchor.
void Estimate::fold()
{
	const size_t half = window_ / 2;
	const double time = samples_[half].time;
	int bounces;
	const Quadratic older = linearise(parameters_, half, nullptr);
	const ParameterMatrix covariance = older.information.llt().solve(ParameterMatrix::Identity());
	Belief then = belief_at(time, covariance * older.gradient, covariance, &bounces);
	parameters_ = belief_at(time, Parameters::Zero(), covariance, &bounces).mean;
	if (bounces > 0) {
		renew_kick(then.mean, then.covariance);
		parameters_.tail<2>().setZero();
	}
	covariance_ = then.covariance;
	prior_mean_ = then.mean;
	prior_information_ = then.covariance.llt().solve(ParameterMatrix::Identity());
	move_anchor(time, half);
}

void Estimate::move_anchor(double time, size_t first)
{
	std::copy(samples_.begin() + first, samples_.begin() + count_, samples_.begin());
	count_ -= first;
	const int64_t moved = std::llround(time * 1e6);
	anchor_ += moved;
	for (size_t i = 0; i < count_; i++)
		samples_[i].time -= static_cast<double>(moved) * 1e-6;
}

// Kalman's, of a point that is where the ball is.
Vector3 velocity_given(const pong_state &predicted, const pong_point &point)
{
	const Eigen::Map<const ParameterMatrix> covariance(&predicted.covariance[0][0]);
	const Matrix3 of_point = Eigen::Map<const Matrix3>(&point.covariance[0][0]);
	const Matrix3 position = covariance.block<3, 3>(PONG_STATE_POSITION, PONG_STATE_POSITION);
	const Matrix3 both = covariance.block<3, 3>(PONG_STATE_VELOCITY, PONG_STATE_POSITION);
	const Vector3 innovation = vector_of(point.position) - vector_of(predicted.position);
	return vector_of(predicted.velocity) + both * (position + of_point).llt().solve(innovation);
}

} // namespace pong
