// What goes wrong with a camera, on order.
#pragma once

#include <cstdint>
#include <limits>
#include <mutex>
#include <random>
#include <vector>

namespace gige
{

enum class FaultKind {
	lose,     // this part of its packets is lost on the way
	reorder,  // this part of its packets is overtaken by the next one
	miss,     // it does not see this part of the trigger's pulses
	truncate, // this part of its pictures ends after half of the packets
	freeze,   // it sends the same picture again and again
	die,      // it has no power: answers nothing, and when the time is over begins anew
	offset,   // its clock is wrong by so many seconds
	drift,    // its clock runs too fast by so many parts in a million; from power-on
	held,     // a client that was killed has left its control behind; at power-on
	block,    // its first picture has this frame id; from power-on
	miscount, // it has counted a pulse too many
};

struct Fault {
	FaultKind kind;
	double amount = 1;
	// By the trigger line: pulse n comes at (n - 1) / rate, s.
	double begin = 0, end = std::numeric_limits<double>::infinity();
};

// For several threads at once.
class Faults
{
public:
	Faults(std::vector<Fault> faults, double rate, uint64_t seed);

	// The fault of this kind at a pulse; nullptr: none.
	const Fault *find(FaultKind kind, int64_t pulse) const;

	// How much of it there is at a pulse; `none` where there is none.
	double amount(FaultKind kind, int64_t pulse, double none = 0) const;

	// Whether it strikes now, drawn with its amount for a probability.
	bool strikes(FaultKind kind, int64_t pulse);

private:
	const std::vector<Fault> faults_;
	const double rate_;
	std::mutex mutex_; // guards the generator
	std::mt19937_64 random_;
};

} // namespace gige
