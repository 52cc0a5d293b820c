#include "clock.hpp"

#include <algorithm>
#include <cmath>

#include "clocks.hpp"

namespace track
{

namespace
{

// The device's clock was latched between the two looks at the host's, however busy that is. A line that says otherwise
// is wrong by its own readings' error, and by what a poor crystal drifts (100 ppm, a few seconds) before that is known.
constexpr double CONTRADICTION_NS = 0.5e6;

// What is known of a crystal's drift before it is measured.
constexpr double DRIFT_SIGMA = 50e-6;

} // namespace

int64_t monotonic_ns()
{
	return pong::read_clock_ns(CLOCK_MONOTONIC);
}

int64_t unix_ns()
{
	return pong::read_clock_ns(CLOCK_REALTIME);
}

bool ClockFit::add(const ClockReading &reading)
{
	const int64_t host_now = reading.before_ns + reading.round_trip_ns() / 2;
	const double limit = CONTRADICTION_NS + static_cast<double>(reading.round_trip_ns() + fastest_ns_) / 2;
	const bool agrees = !known() || std::abs(static_cast<double>(host_ns(reading.device_ns) - host_now)) <= limit;
	if (!agrees)
		count_ = oldest_ = 0;
	fastest_ns_ = known() ? std::min(fastest_ns_, reading.round_trip_ns()) : reading.round_trip_ns();
	if (!known()) {
		first_device_ns_ = reading.device_ns;
		first_difference_ns_ = host_now - reading.device_ns;
	}
	const double sigma = std::max<double>(reading.round_trip_ns(), 1) / std::sqrt(12.0); // ns
	const size_t place = count_ < CAPACITY ? count_++ : oldest_;
	oldest_ = count_ < CAPACITY ? 0 : (place + 1) % CAPACITY;
	samples_[place] = {static_cast<double>(reading.device_ns - first_device_ns_),
			   static_cast<double>(host_now - reading.device_ns - first_difference_ns_),
			   1 / (sigma * sigma)};
	fit();
	return agrees;
}

void ClockFit::fit()
{
	double weight = 0, device = 0, difference = 0;
	for (size_t i = 0; i < count_; i++) {
		weight += samples_[i].weight;
		device += samples_[i].weight * samples_[i].device;
		difference += samples_[i].weight * samples_[i].difference;
	}
	mean_device_ = device / weight;
	offset_ = difference / weight;

	double covariance = 0, variance = 1 / (DRIFT_SIGMA * DRIFT_SIGMA);
	for (size_t i = 0; i < count_; i++) {
		const double x = samples_[i].device - mean_device_;
		covariance += samples_[i].weight * x * (samples_[i].difference - offset_);
		variance += samples_[i].weight * x * x;
	}
	drift_ = covariance / variance;
}

int64_t ClockFit::host_ns(int64_t device_ns) const
{
	const double since = static_cast<double>(device_ns - first_device_ns_) - mean_device_;
	return device_ns + first_difference_ns_ + std::llround(offset_ + drift_ * since);
}

} // namespace track
