#include "flight.hpp"

#include <algorithm>
#include <cmath>

#include "program.hpp"
#include "room.hpp"

namespace sim
{

namespace
{

constexpr double step = 0.002;         // between samples, s: a cubic between them is good to a nanometre
constexpr double longest = 3.0;        // no flight takes longer, s
constexpr double least_rebound = 0.05; // a ball that leaves the table slower rolls: its flight is over, m/s

bool touches_table(const Ball &ball)
{
	return ball.position.y() <= ball_radius && ball.velocity.y() < 0 &&
	       std::abs(ball.position.x()) <= table_width / 2 && ball.position.z() >= 0 &&
	       ball.position.z() <= table_length;
}

// When, from `ball` on, coordinate `axis` comes to `value`: Newton's method, begun by a straight line.
double time_until(const Coefficients &coefficients, const Ball &ball, int axis, double value)
{
	double seconds = (value - ball.position[axis]) / ball.velocity[axis];
	for (int i = 0; i < 4; i++) {
		const Ball there = fly(coefficients, ball, seconds);
		seconds += (value - there.position[axis]) / there.velocity[axis];
	}
	return seconds;
}

bool crosses(const Ball &from, const Ball &to, double z)
{
	return from.position.z() > z && to.position.z() <= z;
}

} // namespace

Flight::Flight(const Coefficients &coefficients, const Ball &launch, const Planes &planes) : over_net_(NAN)
{
	Sample now = {0, launch};
	samples_.push_back(now);
	while (now.time < longest && now.ball.position.z() > planes.end_z && now.ball.position.y() > floor_y) {
		const Sample before = now;
		now = advance(coefficients, before);
		watch(coefficients, before, now, planes.hit_z);
		samples_.push_back(now);
		if (touches_table(now.ball)) {
			if (!hit_)
				bounces_.push_back(now.ball);
			now.ball = bounce(coefficients, now.ball);
			samples_.push_back(now);
			if (now.ball.velocity.y() < least_rebound)
				break;
		}
	}
}

// One step further, or less: onto the table.
Flight::Sample Flight::advance(const Coefficients &coefficients, const Sample &now)
{
	const Ball next = fly(coefficients, now.ball, step);
	if (now.ball.position.y() <= ball_radius || !touches_table(next))
		return {now.time + step, next};
	const double until = time_until(coefficients, now.ball, 1, ball_radius);
	Ball contact = fly(coefficients, now.ball, until);
	contact.position.y() = ball_radius;
	return {now.time + until, contact};
}

void Flight::watch(const Coefficients &coefficients, const Sample &from, const Sample &to, double hit_z)
{
	if (!hit_ && crosses(from.ball, to.ball, hit_z)) {
		const double until = time_until(coefficients, from.ball, 2, hit_z);
		hit_ = Hit{from.time + until, fly(coefficients, from.ball, until).position};
	}
	if (crosses(from.ball, to.ball, net_z)) {
		const double until = time_until(coefficients, from.ball, 2, net_z);
		over_net_ = fly(coefficients, from.ball, until).position.y() - net_height;
	}
}

// Cubic Hermite interpolation of positions between samples.
Ball Flight::at(double time) const
{
	const auto after = std::upper_bound(samples_.begin(), samples_.end(), time,
					    [](double t, const Sample &sample) { return t < sample.time; });
	if (after == samples_.begin())
		return samples_.front().ball;
	if (after == samples_.end())
		return samples_.back().ball;
	const Sample &a = after[-1], &b = after[0];
	const double h = b.time - a.time, s = (time - a.time) / h;
	const double s2 = s * s, s3 = s2 * s;
	Ball ball = a.ball;
	ball.position = (2 * s3 - 3 * s2 + 1) * a.ball.position + (3 * s2 - 2 * s3) * b.ball.position +
			h * ((s3 - 2 * s2 + s) * a.ball.velocity + (s3 - s2) * b.ball.velocity);
	ball.velocity = (1 - s) * a.ball.velocity + s * b.ball.velocity;
	ball.orientation = a.ball.orientation.slerp(s, b.ball.orientation);
	return ball;
}

const std::optional<Hit> &Flight::hit() const
{
	return hit_;
}

const std::vector<Ball> &Flight::bounces() const
{
	return bounces_;
}

double Flight::over_net() const
{
	return over_net_;
}

double Flight::duration() const
{
	return samples_.back().time;
}

} // namespace sim
