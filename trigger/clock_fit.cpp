#include "clock_fit.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace pong
{

namespace
{

constexpr size_t WINDOW = 100;      // samples that the fit looks at
constexpr double SLOW = 1.5;        // a round trip this much slower than the fastest is not believed ...
constexpr double JITTER_NS = 20e3;  // ... but 20 us more are nothing to speak of
constexpr size_t ENOUGH = 10;       // believed samples
constexpr double BASELINE_NS = 4e8; // that they span at least

} // namespace

ClockFit::ClockFit(double ticks_per_second) : nominal_(1e9 / ticks_per_second), slope_(nominal_)
{
}

int64_t ClockFit::unwrap(uint32_t tick) const
{
	if (samples_.empty())
		return tick;
	const int64_t last = samples_.back().tick;
	return last + static_cast<int32_t>(tick - static_cast<uint32_t>(last));
}

void ClockFit::add(int64_t sent, int64_t received, uint32_t tick)
{
	samples_.push_back({sent + (received - sent) / 2, received - sent, unwrap(tick)});
	if (samples_.size() > WINDOW)
		samples_.pop_front();
	fit();
}

void ClockFit::fit()
{
	int64_t fastest = samples_.front().round_trip;
	for (const Sample &sample : samples_)
		fastest = std::min(fastest, sample.round_trip);
	fastest_ = static_cast<double>(fastest) * 1e-9;

	std::vector<Sample> believed;
	for (const Sample &sample : samples_)
		if (static_cast<double>(sample.round_trip) <= SLOW * static_cast<double>(fastest) + JITTER_NS)
			believed.push_back(sample);
	origin_ = believed.back();

	double n = 0, mean_x = 0, mean_y = 0;
	for (const Sample &sample : believed) {
		n++;
		mean_x += (static_cast<double>(sample.tick - origin_.tick) - mean_x) / n;
		mean_y += (static_cast<double>(sample.middle - origin_.middle) - mean_y) / n;
	}
	double xx = 0, xy = 0;
	for (const Sample &sample : believed) {
		const double x = static_cast<double>(sample.tick - origin_.tick) - mean_x;
		const double y = static_cast<double>(sample.middle - origin_.middle) - mean_y;
		xx += x * x;
		xy += x * y;
	}
	slope_ = xx > 0 ? xy / xx : nominal_;
	offset_ = mean_y - slope_ * mean_x;

	double squares = 0;
	for (const Sample &sample : believed)
		squares += std::pow(static_cast<double>(sample.middle - origin_.middle) - offset_ -
					    slope_ * static_cast<double>(sample.tick - origin_.tick),
				    2);
	residual_ = std::sqrt(squares / n) * 1e-9;
	const double baseline = static_cast<double>(believed.back().middle - believed.front().middle);
	settled_ = believed.size() >= ENOUGH && baseline >= BASELINE_NS;
}

bool ClockFit::settled() const
{
	return settled_;
}

int64_t ClockFit::host_ns(uint32_t tick) const
{
	const double ticks = static_cast<double>(unwrap(tick) - origin_.tick);
	return origin_.middle + std::llround(offset_ + slope_ * ticks);
}

double ClockFit::residual() const
{
	return residual_;
}

double ClockFit::fastest() const
{
	return fastest_;
}

} // namespace pong
