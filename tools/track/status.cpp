#include "status.hpp"

#include <algorithm>
#include <cmath>

#include "program.hpp"

namespace track
{

namespace
{

constexpr int64_t SECOND_NS = 1000000000;

int64_t drops_of(const Dropped &dropped, int64_t out_of_order)
{
	return dropped.total() + out_of_order;
}

} // namespace

Status::Status(int64_t now_ns) : begin_ns_(now_ns)
{
}

void Status::count(const pong_sight &sight, double latency_s)
{
	pairs_++;
	outcomes_[sight.outcome]++;
	if (!sight.has_ball)
		return;
	second_.add(latency_s);
	run_[sight.windowed != 0].add(latency_s);
	epipolar_[epipolar_count_++ % EPIPOLAR_BALLS] = sight.ball.epipolar_distance;
	rig_watch_.see(sight.ball);
}

bool Status::second_over(int64_t now_ns) const
{
	return now_ns - begin_ns_ >= SECOND_NS;
}

void Status::close_second(int64_t now_ns, const Source &source)
{
	const Pulses pulses = source.pulses();
	report_.causes = source.dropped();
	report_.cameras = {source.health(PONG_LEFT), source.health(PONG_RIGHT)};
	const double seconds = static_cast<double>(now_ns - begin_ns_) / SECOND_NS;
	const int64_t balls = outcomes_[PONG_SEEN];
	report_.pairs = pairs_;
	report_.dropped = drops_of(report_.causes, outcomes_[PONG_OUT_OF_ORDER]);
	report_.missed_left = pulses.missed[PONG_LEFT];
	report_.missed_right = pulses.missed[PONG_RIGHT];
	report_.outcomes = outcomes_;
	report_.pair_rate = static_cast<double>(pairs_ - pairs_before_) / seconds;
	report_.ball_rate = static_cast<double>(balls - balls_before_) / seconds;
	report_.latency_median = second_.percentile(0.5);
	report_.latency_p99 = second_.percentile(0.99);
	report_.latency_max = second_.max();
	measure_epipolar();
	report_.rig = rig_watch_.offset();
	second_.clear();
	pairs_before_ = pairs_;
	balls_before_ = balls;
	begin_ns_ = now_ns;
}

void Status::measure_epipolar()
{
	const size_t count = std::min(epipolar_count_, EPIPOLAR_BALLS);
	double sum = 0, squares = 0;
	for (size_t i = 0; i < count; i++) {
		sum += epipolar_[i];
		squares += epipolar_[i] * epipolar_[i];
	}
	const double balls = count ? static_cast<double>(count) : NAN;
	report_.epipolar_mean = sum / balls;
	report_.epipolar_rms = std::sqrt(squares / balls);
}

std::string Status::summary(const Source &source) const
{
	const Dropped dropped = source.dropped();
	const Pulses pulses = source.pulses();
	const int64_t out_of_order = outcomes_[PONG_OUT_OF_ORDER];
	const auto number = [](int64_t count) { return static_cast<long long>(count); };
	std::string text = pong::format("%lld pairs, %lld with a ball; %lld pictures dropped (%lld without a partner, "
					"%lld incomplete, %lld too late, %lld out of order)",
					number(pairs_), number(outcomes_[PONG_SEEN]),
					number(drops_of(dropped, out_of_order)), number(dropped.unpaired),
					number(dropped.incomplete), number(dropped.late), number(out_of_order));
	if (dropped.miscounted > 0)
		text += pong::format("; %lld of two pulses, by the cameras' counters", number(dropped.miscounted));
	if (dropped.repeated > 0)
		text += pong::format("; %lld of a frozen camera", number(dropped.repeated));
	const int64_t losses[] = {source.health(PONG_LEFT).losses, source.health(PONG_RIGHT).losses};
	if (losses[PONG_LEFT] + losses[PONG_RIGHT] > 0)
		text += pong::format("; the left camera was lost %lld times, the right %lld times",
				     number(losses[PONG_LEFT]), number(losses[PONG_RIGHT]));
	if (pulses.heard > 0)
		text += pong::format("; %lld trigger pulses heard, missed by the left camera %lld, by the right %lld",
				     number(pulses.heard), number(pulses.missed[PONG_LEFT]),
				     number(pulses.missed[PONG_RIGHT]));
	const char *const where[] = {"searching", "windowed"};
	for (const size_t windowed : {1, 0})
		if (std::isfinite(run_[windowed].max()))
			text += pong::format("; latency %s median %.2f ms, p99 %.2f ms, max %.2f ms", where[windowed],
					     1e3 * run_[windowed].percentile(0.5),
					     1e3 * run_[windowed].percentile(0.99), 1e3 * run_[windowed].max());
	return text;
}

} // namespace track
