#include "prediction_rivals.hpp"

#include <cmath>

#include "simulate/room.hpp"

namespace bench
{

namespace
{

const sim::Coefficients mean;
const sim::Planes planes = {0, -0.4};

double seconds(int64_t from, int64_t to)
{
	return static_cast<double>(to - from) * 1e-6;
}

bool over_table(const Eigen::Vector3d &position)
{
	return std::abs(position.x()) <= sim::table_width / 2 && position.z() >= 0 && position.z() <= sim::table_length;
}

// The ball after `duration`, through a bounce on the way; whether there was one.
bool fly_on(sim::Ball &ball, double duration)
{
	const sim::Ball next = sim::fly(mean, ball, duration);
	const double above = ball.position.y() - sim::ball_radius, below = next.position.y() - sim::ball_radius;
	if (!(above > 0 && below < 0 && over_table(next.position))) {
		ball = next;
		return false;
	}
	double until = duration * above / (above - below);
	for (int i = 0; i < 3; i++) {
		const sim::Ball there = sim::fly(mean, ball, until);
		until -= (there.position.y() - sim::ball_radius) / there.velocity.y();
	}
	sim::Ball contact = sim::fly(mean, ball, until);
	contact.position.y() = sim::ball_radius;
	ball = sim::fly(mean, sim::bounce(mean, contact), duration - until);
	return true;
}

sim::Ball ball_of(const Eigen::VectorXd &state)
{
	sim::Ball ball;
	ball.position = state.segment<3>(0);
	ball.velocity = state.segment<3>(3);
	if (state.size() > 6)
		ball.spin = state.segment<3>(6);
	return ball;
}

std::optional<Guess> hit_of(const sim::Ball &ball, double time)
{
	const sim::Flight flight(mean, ball, planes);
	if (!flight.hit())
		return std::nullopt;
	return Guess{flight.hit()->position, time + flight.hit()->time};
}

Eigen::Vector3d position_of(const pong_point &point)
{
	return Eigen::Map<const Eigen::Vector3d>(point.position);
}

Eigen::Matrix3d covariance_of(const pong_point &point)
{
	return Eigen::Map<const Eigen::Matrix3d>(&point.covariance[0][0]);
}

// Where the leg since the last bounce begins: after the lowest point that was followed by a rise.
size_t leg_begin(const std::vector<pong_point> &points)
{
	size_t lowest = 0;
	for (size_t i = 1; i + 2 < points.size(); i++)
		if (points[i].position[1] < 0.1 && points[i].position[1] <= points[i - 1].position[1] &&
		    points[i].position[1] < points[i + 1].position[1])
			lowest = i + 1;
	return lowest;
}

} // namespace

KalmanFilter::KalmanFilter(double spin_sigma) : spin_sigma_(spin_sigma)
{
}

void KalmanFilter::begin(const pong_point &point)
{
	first_utime_ = point.utime;
	state_ << position_of(point), 0, 0.5, -8, 0, 0, 0;
	covariance_.setZero();
	covariance_.topLeftCorner<3, 3>() = covariance_of(point);
	covariance_.diagonal().segment<3>(3).setConstant(25);
	covariance_.diagonal().segment<3>(6).setConstant(spin_sigma_ * spin_sigma_);
}

// Jacobian by differences; noise for what differs from flight to flight: drag in the air, all else at the bounce.
void KalmanFilter::go_on(double duration)
{
	Covariance rates;
	for (int i = 0; i < 9; i++) {
		const double step = i < 3 ? 1e-5 : i < 6 ? 1e-4 : 0.05;
		sim::Ball more = ball_of(state_ + step * State::Unit(i)),
			  less = ball_of(state_ - step * State::Unit(i));
		fly_on(more, duration);
		fly_on(less, duration);
		rates.col(i) << more.position - less.position, more.velocity - less.velocity, more.spin - less.spin;
		rates.col(i) /= 2 * step;
	}
	sim::Ball ball = ball_of(state_);
	const bool bounced = fly_on(ball, duration);
	state_ << ball.position, ball.velocity, ball.spin;
	covariance_ = rates * covariance_ * rates.transpose();
	covariance_.diagonal().segment<3>(3).array() += std::pow(0.5 * duration, 2);
	if (bounced)
		covariance_.diagonal() += (State() << 0, 1e-6, 0, 0.01, 0.01, 0.01, 100, 100, 100).finished();
}

void KalmanFilter::add(const pong_point &point)
{
	if (count_++ == 0) {
		begin(point);
	} else {
		go_on(seconds(utime_, point.utime));
		const Eigen::Matrix3d spread = covariance_.topLeftCorner<3, 3>() + covariance_of(point);
		const Eigen::Matrix<double, 9, 3> gain = covariance_.leftCols<3>() * spread.inverse();
		state_ += gain * (position_of(point) - state_.head<3>());
		covariance_ -= (gain * covariance_.topRows<3>()).eval();
		covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
	}
	utime_ = point.utime;
}

std::optional<Guess> KalmanFilter::guess() const
{
	if (count_ < 3)
		return std::nullopt;
	return hit_of(ball_of(state_), seconds(first_utime_, utime_));
}

std::optional<Guess> least_squares(const std::vector<pong_point> &points)
{
	size_t begin = leg_begin(points);
	const size_t end = points.size() - begin >= 4 || begin == 0 ? points.size() : begin;
	begin = end == begin ? 0 : begin;
	if (end - begin < 3)
		return std::nullopt;
	using State = Eigen::Matrix<double, 6, 1>;
	State state;
	state << position_of(points[begin]), (position_of(points[end - 1]) - position_of(points[begin])) /
						     seconds(points[begin].utime, points[end - 1].utime);
	for (int round = 0; round < 4; round++) {
		Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
		State gradient = State::Zero();
		for (size_t i = begin; i < end; i++) {
			const double time = seconds(points[begin].utime, points[i].utime);
			const auto at = [&](const State &from) { return sim::fly(mean, ball_of(from), time).position; };
			Eigen::Matrix<double, 3, 6> rates;
			for (int k = 0; k < 6; k++)
				rates.col(k) =
					(at(state + 1e-4 * State::Unit(k)) - at(state - 1e-4 * State::Unit(k))) / 2e-4;
			const Eigen::Matrix<double, 6, 3> weighted =
				rates.transpose() * covariance_of(points[i]).inverse();
			information += weighted * rates;
			gradient += weighted * (position_of(points[i]) - at(state));
		}
		state += information.ldlt().solve(gradient);
	}
	return hit_of(ball_of(state), seconds(points[0].utime, points[begin].utime));
}

} // namespace bench
