// A trigger on USB that answers with any bytes: what the host makes of them. Time is emulated too, and passes quickly.
#include <algorithm>
#include <cstdint>
#include <cstring>

#include "host_clock.hpp"
#include "program.hpp"
#include "usb_port.hpp"

namespace
{

const uint8_t *bytes;
size_t left;
int64_t now_ns;

// What the device says next; nothing more: it is unplugged.
void answer(void *data, size_t size)
{
	if (left < size)
		throw pong::Failure("unplugged");
	memcpy(data, bytes, size);
	bytes += size;
	left -= size;
}

} // namespace

namespace pong
{

// Each look at the clock takes 1 ms.
int64_t monotonic_ns()
{
	return now_ns += 1000000;
}

int64_t utime_of(int64_t monotonic)
{
	return monotonic / 1000;
}

UsbDevice::UsbDevice(const std::string &)
{
}

UsbDevice::~UsbDevice() = default;

void UsbDevice::send(pong_trigger_request, uint16_t, const void *, size_t, const char *)
{
}

void UsbDevice::fetch(pong_trigger_request, void *data, size_t size)
{
	answer(data, size);
}

// Draining what an earlier program has left ends, because a device runs out of it.
size_t UsbDevice::read_pulses(pong_trigger_pulse pulses[PONG_TRIGGER_PULSES_PER_PACKET], unsigned milliseconds)
{
	now_ns += milliseconds * INT64_C(1000000);
	uint8_t count;
	answer(&count, 1);
	count %= PONG_TRIGGER_PULSES_PER_PACKET + 1;
	answer(pulses, count * sizeof *pulses);
	return count;
}

} // namespace pong

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	bytes = data;
	left = size;
	now_ns = 0;
	try {
		pong::UsbPort port("");
		pong::Settings settings;
		settings.rate = 110;
		settings.width = 0.002;
		settings.count = 5;
		port.start(settings);
		std::vector<pong::Pulse> pulses;
		while (port.wait(0.1, &pulses))
			pulses.clear();
	} catch (const pong::Failure &) {
		return 0; // one sentence: as it should be
	}
	return 0;
}
