// The host's clocks, and a camera's clock as seen from the host.
#pragma once

#include <cstddef>
#include <cstdint>

namespace track
{

// For intervals: never set, never steps.
int64_t monotonic_ns();

// For utimes: nanoseconds since the Unix epoch.
int64_t unix_ns();

// The device's clock, latched at an unknown moment between two looks at the host's.
struct ClockReading {
	int64_t device_ns;
	int64_t before_ns, after_ns; // host

	int64_t round_trip_ns() const
	{
		return after_ns - before_ns;
	}
};

// Maps the device's clock to the host's: a straight line through the last readings, by least squares.
//
//     host = device + offset + drift * (device - device of the readings' mean)
//
// A reading is taken for the middle of its round trip; its error is spread evenly over that, so its variance is
// (round trip)^2 / 12. The drift is 0 +- 50 ppm before there is a second reading, and measured better and better after.
class ClockFit
{
public:
	// False for a reading that contradicts the line by more than a crystal can drift: a clock was set, and it
	// begins a new line.
	bool add(const ClockReading &reading);

	bool known() const
	{
		return count_ > 0;
	}

	// Host time of a device time; only where known().
	int64_t host_ns(int64_t device_ns) const;

	// How much faster the host's clock runs: 1e-6 is one part in a million.
	double drift() const
	{
		return drift_;
	}

private:
	static constexpr size_t CAPACITY = 32;

	struct Sample {
		double device, difference; // ns, both relative to the first reading
		double weight;
	};

	void fit();

	Sample samples_[CAPACITY];
	size_t count_ = 0, oldest_ = 0;
	int64_t fastest_ns_ = 0; // round trip
	int64_t first_device_ns_ = 0, first_difference_ns_ = 0;
	double mean_device_ = 0, offset_ = 0, drift_ = 0;
};

} // namespace track
