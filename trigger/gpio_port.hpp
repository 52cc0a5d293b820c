// Pulses by a thread that sleeps until each edge and sets GPIO lines: as good as the kernel's scheduler.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "gpio_lines.hpp"
#include "lateness.hpp"
#include "port.hpp"
#include "pulse_queue.hpp"

namespace pong
{

class GpioPort final : public Port
{
public:
	// Throws UsageError where `text` is not CHIP:LINE[,LINE].
	explicit GpioPort(const std::string &text);
	~GpioPort() override;

	void start(const Settings &settings) override;
	bool wait(double seconds, std::vector<Pulse> *pulses) override;
	std::string stop() override;

private:
	void make_pulses();
	bool make_pulse(int64_t due, int64_t number);
	bool set(bool active);
	void wake();
	void sleep_until(int64_t moment) const;

	GpioSpec spec_;
	Settings settings_;
	std::unique_ptr<GpioLines> lines_;
	std::thread thread_;
	std::atomic<bool> stopping_ = false, done_ = false;
	std::atomic<int> error_ = 0; // errno of the kernel's refusal to set a line
	PulseQueue queue_;
	int event_ = -1; // wakes wait() at every pulse
	// Of the thread, until it is joined.
	Lateness lateness_;
	int64_t made_ = 0, skipped_ = 0;
};

} // namespace pong
