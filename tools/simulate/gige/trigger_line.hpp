// The wire that triggers the cameras: pulses of a fixed rate, whose times are known beforehand; or those of a trigger
// outside, which are known when they have come.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <optional>

namespace gige
{

struct Pulse {
	int64_t number; // 1 for the first
	int64_t time;   // of its rising edge, ns of CLOCK_MONOTONIC
};

// Times origin + k / rate, rounded to whole nanoseconds one by one, so that they don't drift.
struct Schedule {
	int64_t origin = 0;
	double rate = 1; // Hz

	int64_t time(int64_t k) const;
	// The least k with time(k) >= time.
	int64_t first_from(int64_t time) const;
	// The k whose time is nearest.
	int64_t nearest(int64_t time) const;
};

// For several threads at once.
class TriggerLine
{
public:
	// `power_on` is when the world begins.
	TriggerLine(double rate, int64_t power_on);

	// From now on its pulses are those that come from outside, and it runs for ever.
	void connect_outside();

	// A rising edge from outside.
	void add_edge(int64_t time);

	// End with this pulse; 0: never.
	void end_at(int64_t number);

	// Go on with the pulse after the last that came, at time `origin`.
	void start(int64_t origin);
	void stop();
	bool is_running() const;

	// The first pulse at `earliest` or later; none: the line is still, or has ended.
	std::optional<Pulse> next(int64_t earliest) const;

	// When the pulse comes that take() waits for; none: none will.
	std::optional<int64_t> next_time() const;

	// The next pulse that has come by `now`, each once and in order.
	std::optional<Pulse> take(int64_t now);

	// All of its pulses have come.
	bool has_ended() const;

	// How many have been taken so far.
	int64_t count() const;

	// The number of the pulse nearest to a time. While the line is still: as if it had begun at power-on.
	int64_t number_at(int64_t time) const;

private:
	static constexpr int64_t recent = 64; // edges from outside that are remembered

	bool exists(int64_t number) const;
	int64_t time_of(int64_t number) const;

	mutable std::mutex mutex_;
	const int64_t power_on_;
	int64_t last_ = 0;
	Schedule schedule_;
	bool running_ = false;
	int64_t first_ = 1; // the pulse of the schedule's origin
	int64_t next_ = 1;  // the pulse that take() waits for
	bool is_outside_ = false;
	std::array<int64_t, recent> edges_ = {}; // by number % recent
	int64_t edge_count_ = 0;
};

} // namespace gige
