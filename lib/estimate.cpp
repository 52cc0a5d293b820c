#include "estimate.hpp"

#include <algorithm>
#include <cmath>

namespace pong
{

namespace
{

const size_t begin_points = 12;   // a flight so young may still need a few steps a point
const int begin_steps = 6;        // while young
const int steady_steps = 3;       // later
const double settled = 1e-2;      // a step this small, in squared standard deviations, ends the search
const double outlier = 16;        // squared normalised distance that one in a thousand good points exceeds
const size_t outlier_points = 6;  // fewer points cannot tell which of them is wrong
const double position_sigma = 10; // m: none that matters
const Vector3 usual_velocity(0, 0.5, -6), velocity_sigma(3, 3, 6); // m/s, of play in ball-states

double square(double value)
{
	return value * value;
}

double seconds(int64_t from, int64_t to)
{
	return static_cast<double>(to - from) * 1e-6;
}

Parameters usual_parameters(const pong_ball_spec &ball)
{
	Parameters usual;
	usual << 0, 0, 0, usual_velocity, 0, 0, 0, ball.drag, ball.magnus, ball.restitution, ball.friction, ball.grip,
		0, 0;
	return usual;
}

Parameters usual_sigmas(const pong_ball_spec &ball)
{
	Parameters sigmas;
	sigmas << Vector3::Constant(position_sigma), velocity_sigma, Vector3::Constant(ball.spin_sigma),
		ball.drag_sigma, ball.magnus_sigma, ball.restitution_sigma, ball.friction_sigma, ball.grip_sigma,
		ball.kick, ball.kick;
	return sigmas;
}

} // namespace

Estimate::Estimate(const pong_rig &rig) : rig_(rig), physics_(rig)
{
	clear();
}

void Estimate::clear()
{
	count_ = 0;
	prior_mean_ = usual_parameters(rig_.ball);
	prior_information_ = usual_sigmas(rig_.ball).cwiseMax(1e-9).array().square().inverse().matrix().asDiagonal();
}

void Estimate::begin(const pong_point &point)
{
	anchor_ = point.utime;
	prior_mean_.segment<3>(PONG_STATE_POSITION) = vector_of(point.position);
	parameters_ = prior_mean_;
}

void Estimate::add(const pong_point &point)
{
	if (count_ == 0)
		begin(point);
	if (count_ == window_)
		fold();
	const Matrix3 covariance = Eigen::Map<const Matrix3>(&point.covariance[0][0]);
	samples_[count_++] = {seconds(anchor_, point.utime), vector_of(point.position), covariance.inverse()};
	improve();
	find_state();
}

Estimate::Quadratic Estimate::prior_at(const Parameters &parameters) const
{
	const Parameters gradient = prior_information_ * (prior_mean_ - parameters);
	return {gradient.dot(prior_mean_ - parameters), gradient, prior_information_};
}

// The cost of the first samples about some parameters. A point far off the flight counts less, the farther the less.
Estimate::Quadratic Estimate::linearise(const Parameters &parameters, size_t samples) const
{
	Quadratic quadratic = prior_at(parameters);
	Trajectory trajectory(physics_, rig_.table, parameters);
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
	return quadratic;
}

// The cost is a narrow curved valley: full steps follow it where steps that insist on a lower cost every time creep.
void Estimate::improve()
{
	Parameters best = parameters_;
	double least = std::numeric_limits<double>::infinity();
	const int steps = count_ <= begin_points ? begin_steps : steady_steps;
	for (int i = 0; i < steps; i++) {
		quadratic_ = linearise(parameters_, count_);
		if (quadratic_.cost < least) {
			least = quadratic_.cost;
			best = parameters_;
		}
		const Parameters step = quadratic_.information.llt().solve(quadratic_.gradient);
		if (!step.allFinite())
			break;
		parameters_ += step;
		if (step.dot(quadratic_.gradient) < settled)
			return;
	}
	if (!(linearise(parameters_, count_).cost < least))
		parameters_ = best;
}

void Estimate::find_state()
{
	Trajectory trajectory(physics_, rig_.table, parameters_);
	const double time = samples_[count_ - 1].time;
	while (time > trajectory.end().time)
		trajectory.advance(time);
	const Motion &now = trajectory.end();
	ParameterMatrix rates = ParameterMatrix::Identity();
	rates.middleRows<3>(PONG_STATE_POSITION) = now.position_rates;
	rates.middleRows<3>(PONG_STATE_VELOCITY) = now.velocity_rates;
	rates.middleRows<3>(PONG_STATE_SPIN) = now.spin_rates;
	Parameters coefficients = parameters_;
	double kick_variance = 0;
	if (trajectory.bounces() > 0) {
		rates.bottomRows<2>().setZero(); // the next bounce has a kick of its own
		coefficients.tail<2>().setZero();
		kick_variance = square(rig_.ball.kick);
	}
	const ParameterMatrix covariance = quadratic_.information.llt().solve(ParameterMatrix::Identity());
	Eigen::Map<Eigen::Matrix<double, parameter_count, parameter_count, Eigen::RowMajor>> out(
		&state_.covariance[0][0]);
	out = rates * covariance * rates.transpose();
	out(PONG_STATE_KICK_X, PONG_STATE_KICK_X) += kick_variance;
	out(PONG_STATE_KICK_Z, PONG_STATE_KICK_Z) += kick_variance;

	state_.utime = anchor_ + std::llround(time * 1e6);
	store(now.position, state_.position);
	store(now.velocity, state_.velocity);
	state_.has_spin = 1;
	store(now.spin, state_.spin);
	Eigen::Map<Eigen::Matrix<double, 7, 1>>{state_.coefficients} = coefficients.tail<7>();
}

bool Estimate::state(pong_state *state) const
{
	if (count_ == 0)
		return false;
	*state = state_;
	return true;
}

// The older half's cost, a quadratic about the present estimate, carried to the ball at the first of the newer points:
// the new anchor.
void Estimate::fold()
{
	const size_t half = window_ / 2;
	const Quadratic old = linearise(parameters_, half);
	const double time = samples_[half].time;
	Trajectory trajectory(physics_, rig_.table, parameters_);
	while (time > trajectory.end().time)
		trajectory.advance(time);
	const Motion &now = trajectory.end();

	Eigen::Matrix<double, parameter_count, parameter_count> rates = ParameterMatrix::Identity();
	rates.middleRows<3>(PONG_STATE_POSITION) = now.position_rates;
	rates.middleRows<3>(PONG_STATE_VELOCITY) = now.velocity_rates;
	rates.middleRows<3>(PONG_STATE_SPIN) = now.spin_rates;
	const Parameters step = old.information.llt().solve(old.gradient);
	ParameterMatrix covariance = rates * old.information.llt().solve(rates.transpose());
	Parameters mean = parameters_;
	mean.segment<3>(PONG_STATE_POSITION) = now.position;
	mean.segment<3>(PONG_STATE_VELOCITY) = now.velocity;
	mean.segment<3>(PONG_STATE_SPIN) = now.spin;
	parameters_ = mean;
	mean += rates * step;
	if (trajectory.bounces() > 0) {
		for (int kick = PONG_STATE_KICK_X; kick <= PONG_STATE_KICK_Z; kick++) {
			covariance.row(kick).setZero();
			covariance.col(kick).setZero();
			covariance(kick, kick) = square(rig_.ball.kick);
			mean[kick] = parameters_[kick] = 0;
		}
	}
	prior_mean_ = mean;
	prior_information_ = covariance.llt().solve(ParameterMatrix::Identity());
	std::copy(samples_.begin() + half, samples_.end(), samples_.begin());
	count_ = half;
	const int64_t moved = std::llround(time * 1e6);
	anchor_ += moved;
	for (size_t i = 0; i < count_; i++)
		samples_[i].time -= static_cast<double>(moved) * 1e-6;
}

} // namespace pong
