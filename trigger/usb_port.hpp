// Pulses by the microcontroller: edges by its timer, exact to its crystal; their times by a fit of the two clocks.
#pragma once

#include <string>
#include <vector>

#include "clock_fit.hpp"
#include "port.hpp"
#include "usb_device.hpp"

namespace pong
{

class UsbPort final : public Port
{
public:
	// Throws Failure where there is no such device, or its firmware is of another version.
	explicit UsbPort(const std::string &serial);
	~UsbPort() override;

	// Returns when the clocks have been fitted and the first pulse is on its way, or the edge awaited.
	void start(const Settings &settings) override;
	bool wait(double seconds, std::vector<Pulse> *pulses) override;
	std::string stop() override;

	// Gives the device a name or a serial number, for ever.
	void write_label(pong_trigger_label which, const std::string &text);

private:
	void check_version();
	void drain();
	void settle();
	void ask();
	void read(double seconds, std::vector<Pulse> *pulses);

	UsbDevice device_;
	ClockFit clock_{PONG_TRIGGER_TICKS_PER_SECOND};
	Settings settings_;
	pong_trigger_status status_ = {};
	int64_t asked_ = 0;     // when, monotonic ns
	uint32_t received_ = 0; // pulses
	bool running_ = false;
};

} // namespace pong
