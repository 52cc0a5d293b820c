#include "outlook.hpp"

#include <cmath>
#include <limits>

#include "trajectory.hpp"

namespace pong
{

namespace
{

const double net_overhang = 0.1525;  // the net reaches this far beyond the side lines, m
const double below_surface = -0.002; // a ball's centre that low over the table is an impossibility, m

Parameters parameters_of(const pong_rig &rig, const pong_state &state)
{
	const pong_ball_spec &ball = rig.ball;
	Parameters parameters;
	parameters << vector_of(state.position), vector_of(state.velocity), 0, 0, 0, ball.drag, ball.magnus,
		ball.restitution, ball.friction, ball.grip, rig.table.height, 0, 0;
	if (state.has_spin) {
		parameters.segment<3>(PONG_STATE_SPIN) = vector_of(state.spin);
		parameters.tail<coefficient_count>() = Eigen::Map<const Coefficients>(state.coefficients);
	}
	return parameters;
}

// Symmetric: by rows or by columns is the same.
ParameterMatrix covariance_of(const pong_state &state)
{
	return Eigen::Map<const ParameterMatrix>(&state.covariance[0][0]);
}

class Outlook
{
public:
	Outlook(const pong_rig &rig, const pong_state &state, const pong_settings &settings)
		: rig_(rig), state_(state), settings_(settings), physics_(rig), parameters_(parameters_of(rig, state)),
		  covariance_(covariance_of(state)),
		  trajectory_(physics_, rig.table, parameters_, state.has_spin ? &covariance_ : nullptr)
	{
	}

	void look(pong_prediction &prediction)
	{
		prediction.has_bounce = prediction.has_hit = prediction.has_top = 0;
		while (trajectory_.end().time < settings_.predict.horizon && !finished(prediction)) {
			trajectory_.advance(settings_.predict.horizon);
			if (meets_net() || meets_table_sideways())
				break;
			note_path(prediction);
			note_hit(prediction);
			note_bounce(prediction);
			note_top(prediction);
		}
	}

	void look_to(double time, pong_state &then)
	{
		while (trajectory_.end().time < time)
			trajectory_.advance(time);
		then = state_of(trajectory_.end());
	}

private:
	int64_t utime_of(double time) const
	{
		return state_.utime + std::llround(time * 1e6);
	}

	pong_state state_of(const Motion &motion) const
	{
		pong_state state = {};
		state.utime = utime_of(motion.time);
		store(motion.position, state.position);
		store(motion.velocity, state.velocity);
		state.has_spin = state_.has_spin;
		if (!state.has_spin)
			return state;
		store(motion.spin, state.spin);
		Eigen::Map<Coefficients>{state.coefficients} = parameters_.tail<coefficient_count>();
		Eigen::Map<ParameterMatrix>{&state.covariance[0][0]} = carry(covariance(), motion);
		return state;
	}

	// What the next bounce leaves to chance is as if its kick were less known.
	ParameterMatrix covariance() const
	{
		ParameterMatrix covariance = covariance_;
		covariance.bottomRightCorner<2, 2>() += trajectory_.scatter();
		return covariance;
	}

	// Whether the present stretch passes the plane, from whichever side.
	bool passes(int axis, double value) const
	{
		const double begin = trajectory_.begin().position[axis] - value;
		const double end = trajectory_.end().position[axis] - value;
		return (begin > 0 && end <= 0) || (begin < 0 && end >= 0);
	}

	bool meets_net() const
	{
		const pong_table &table = rig_.table;
		if (!table.present || !(table.net > 0) || !passes(2, table.length / 2))
			return false;
		const Vector3 there = trajectory_.position(trajectory_.time_at(2, table.length / 2));
		return there.y() < table.net + physics_.radius() && there.y() > 0 &&
		       std::abs(there.x()) < table.width / 2 + net_overhang + physics_.radius();
	}

	// The edge, or the body of the table: where a ball goes from there nobody knows.
	bool meets_table_sideways() const
	{
		const pong_table &table = rig_.table;
		const Vector3 &end = trajectory_.end().position;
		const double contact = physics_.contact_height(parameters_), surface = parameters_[PONG_STATE_HEIGHT];
		if (!table.present || trajectory_.ends_on_table() || end.y() > contact)
			return false;
		if (passes(1, contact))
			return near_table(trajectory_.position(trajectory_.time_at(1, contact)));
		return end.y() < surface + below_surface && end.y() > surface - physics_.radius() && near_table(end);
	}

	bool near_table(const Vector3 &position) const
	{
		const double reach = physics_.radius();
		return std::abs(position.x()) < rig_.table.width / 2 + reach && position.z() > -reach &&
		       position.z() < rig_.table.length + reach;
	}

	void note_path(pong_prediction &prediction) const
	{
		for (;;) {
			const double time = prediction.path_count * settings_.predict.path_step;
			if (prediction.has_hit || prediction.path_count == PONG_PATH_CAPACITY ||
			    time >= trajectory_.end().time)
				return;
			auto &point = prediction.path[prediction.path_count];
			point.utime = utime_of(time);
			store(trajectory_.position(time), point.position);
			prediction.path_count++;
		}
	}

	void note_hit(pong_prediction &prediction) const
	{
		if (prediction.has_hit || !passes(2, rig_.hit_z) || trajectory_.end().velocity.z() > 0)
			return;
		const Motion hit = trajectory_.motion(trajectory_.time_at(2, rig_.hit_z));
		prediction.has_hit = 1;
		prediction.hit = state_of(hit);
		if (state_.has_spin)
			note_hit_covariance(hit, prediction);
		drop_path_after(hit.time, prediction);
	}

	// On the plane z is certain, and time is not: dt = -dz / v_z.
	void note_hit_covariance(const Motion &hit, pong_prediction &prediction) const
	{
		Eigen::Matrix<double, 4, parameter_count> rates;
		rates.row(3) = -hit.position_rates.row(2) / hit.velocity.z();
		rates.topRows<3>() = hit.position_rates + hit.velocity * rates.row(3);
		rates.row(2).setZero();
		Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>{&prediction.hit_covariance[0][0]} =
			rates * covariance() * rates.transpose();
	}

	void drop_path_after(double time, pong_prediction &prediction) const
	{
		while (prediction.path_count > 0 && prediction.path[prediction.path_count - 1].utime >= utime_of(time))
			prediction.path_count--;
		if (prediction.path_count == PONG_PATH_CAPACITY)
			return;
		auto &point = prediction.path[prediction.path_count++];
		point.utime = prediction.hit.utime;
		std::copy_n(prediction.hit.position, 3, point.position);
	}

	void note_bounce(pong_prediction &prediction) const
	{
		if (prediction.has_bounce || prediction.has_hit || !trajectory_.ends_on_table())
			return;
		prediction.has_bounce = 1;
		prediction.bounce = state_of(trajectory_.end());
	}

	void note_top(pong_prediction &prediction) const
	{
		const Motion &begin = trajectory_.begin(), &end = trajectory_.end();
		if (prediction.has_top || trajectory_.bounces() == 0 || begin.velocity.y() < 0 || end.velocity.y() > 0)
			return;
		const double part = begin.velocity.y() / (begin.velocity.y() - end.velocity.y());
		prediction.has_top = 1;
		prediction.top = state_of(trajectory_.motion(begin.time + part * (end.time - begin.time)));
	}

	// A ball that was still to bounce has a highest point after the hit plane, where it has none before.
	bool finished(const pong_prediction &prediction) const
	{
		return prediction.has_hit && (prediction.has_top || trajectory_.bounces() == 0);
	}

	const pong_rig &rig_;
	const pong_state &state_;
	const pong_settings &settings_;
	const Physics physics_;
	const Parameters parameters_;
	const ParameterMatrix covariance_; // of the state
	Trajectory trajectory_;
};

bool finite(const pong_state &state)
{
	return vector_of(state.position).allFinite() && vector_of(state.velocity).allFinite();
}

} // namespace

bool look_ahead(const pong_rig &rig, const pong_state &state, const pong_settings &settings,
		pong_prediction &prediction)
{
	if (!finite(state))
		return false;
	if (state.has_spin)
		std::copy_n(state.spin, 3, prediction.spin);
	Outlook(rig, state, settings).look(prediction);
	return true;
}

bool look_ahead_to(const pong_rig &rig, const pong_state &state, int64_t utime, const pong_settings &settings,
		   pong_state &then)
{
	const double duration = static_cast<double>(utime - state.utime) * 1e-6;
	if (!finite(state) || duration < 0 || duration > settings.predict.horizon)
		return false;
	Outlook(rig, state, settings).look_to(duration, then);
	return true;
}

} // namespace pong
