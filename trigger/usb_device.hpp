// A Pongeye trigger on USB: found, opened, asked. Every failure is one sentence.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "protocol.h"

struct libusb_context;
struct libusb_device;
struct libusb_device_handle;

namespace pong
{

class UsbDevice
{
public:
	// The device with this serial number; any where it is empty, as long as there is only one.
	explicit UsbDevice(const std::string &serial);
	~UsbDevice();
	UsbDevice(const UsbDevice &) = delete;
	UsbDevice &operator=(const UsbDevice &) = delete;

	// Throw Failure; `what` says what was asked for, where the device refuses it.
	void send(pong_trigger_request request, uint16_t value, const void *data, size_t size, const char *what);
	void fetch(pong_trigger_request request, void *data, size_t size);

	// Waits up to `milliseconds` for pulses; returns how many came.
	size_t read_pulses(pong_trigger_pulse pulses[PONG_TRIGGER_PULSES_PER_PACKET], unsigned milliseconds);

private:
	struct Search;
	void look_at(libusb_device *device, Search *search);
	void open(const std::string &serial);
	int control(uint8_t direction, pong_trigger_request request, uint16_t value, void *data, size_t size);

	libusb_context *context_ = nullptr;
	libusb_device_handle *handle_ = nullptr;
};

} // namespace pong
