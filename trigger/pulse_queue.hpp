// Pulses on their way from the thread that makes them to the one that tells of them: neither waits for the other.
#pragma once

#include <array>
#include <atomic>

#include "port.hpp"

namespace pong
{

class PulseQueue
{
public:
	// By the making thread. False where nobody has fetched for so long that there is no room.
	bool push(const Pulse &pulse)
	{
		const size_t head = head_.load(std::memory_order_relaxed);
		if (head - tail_.load(std::memory_order_acquire) == pulses_.size())
			return false;
		pulses_[head % pulses_.size()] = pulse;
		head_.store(head + 1, std::memory_order_release);
		return true;
	}

	// By the telling thread. False where there is none.
	bool pop(Pulse *pulse)
	{
		const size_t tail = tail_.load(std::memory_order_relaxed);
		if (tail == head_.load(std::memory_order_acquire))
			return false;
		*pulse = pulses_[tail % pulses_.size()];
		tail_.store(tail + 1, std::memory_order_release);
		return true;
	}

private:
	std::array<Pulse, 1024> pulses_;
	std::atomic<size_t> head_ = 0, tail_ = 0; // count on; the place is their remainder
};

} // namespace pong
