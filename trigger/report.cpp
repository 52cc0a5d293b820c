#include "report.hpp"

#include <algorithm>

#include "host_clock.hpp"

namespace pong
{

namespace
{

constexpr int64_t SECOND_NS = 1'000'000'000;

// Pulses a second between the first and the last whose times are known; NaN where there are not two.
double rate_of(const std::vector<Pulse> &pulses)
{
	const auto known = [](const Pulse &pulse) { return pulse.utime != 0; };
	const auto first = std::find_if(pulses.begin(), pulses.end(), known);
	const auto last = std::find_if(pulses.rbegin(), pulses.rend(), known);
	if (first == pulses.end() || last->utime == first->utime)
		return NAN;
	return static_cast<double>(last->number - first->number) * 1e6 /
	       static_cast<double>(last->utime - first->utime);
}

} // namespace

void Report::add(const Pulse &pulse)
{
	pulses_ = pulse.number;
	late_ += pulse.lateness > Lateness::LATE;
	second_.push_back(pulse);
}

void Report::tick()
{
	const int64_t now = monotonic_ns();
	if (next_ == 0)
		next_ = now + SECOND_NS;
	if (now < next_)
		return;
	write(now);
	next_ = std::max(next_ + SECOND_NS, now);
}

// A port that makes edges by a timer knows no lateness, and one that makes them by our clock has no residual; PWM
// knows neither.
void Report::write(int64_t now)
{
	double residual = NAN, lateness = NAN;
	for (const Pulse &pulse : second_) {
		lateness = std::fmax(lateness, pulse.lateness);
		if (pulse.utime && std::isnan(pulse.lateness))
			residual = pulse.residual;
	}
	table_.add(utime_of(now));
	table_.add(pulses_);
	table_.add(rate_of(second_), 4);
	table_.add(residual * 1e6, 1);
	table_.add(lateness * 1e6, 1);
	if (std::isnan(lateness))
		table_.add_absent();
	else
		table_.add(late_);
	table_.end_row();
	second_.clear();
}

} // namespace pong
