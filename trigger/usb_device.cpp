#include "usb_device.hpp"

#include <libusb.h>

#include "program.hpp"

namespace pong
{

namespace
{

constexpr unsigned PATIENCE_MS = 1000;
constexpr int INTERFACE = 0;

std::string string_of(libusb_device_handle *handle, uint8_t index)
{
	unsigned char text[128];
	const int length = index ? libusb_get_string_descriptor_ascii(handle, index, text, sizeof text) : 0;
	return length > 0 ? std::string(text, text + length) : "";
}

[[noreturn]] void fail(int error)
{
	if (error == LIBUSB_ERROR_NO_DEVICE)
		throw Failure("the trigger has been unplugged");
	throw Failure(std::string("the trigger does not answer on USB: ") + libusb_strerror(error));
}

} // namespace

// What a look through the bus has found.
struct UsbDevice::Search {
	std::string wanted, serials;
	int found = 0;
	std::string forbidden; // the file of a device that we may not open
};

UsbDevice::UsbDevice(const std::string &serial)
{
	if (const int error = libusb_init(&context_))
		throw Failure(std::string("no USB on this machine: ") + libusb_strerror(error));
	try {
		open(serial);
	} catch (...) {
		libusb_close(handle_);
		libusb_exit(context_);
		throw;
	}
}

UsbDevice::~UsbDevice()
{
	libusb_release_interface(handle_, INTERFACE);
	libusb_close(handle_);
	libusb_exit(context_);
}

// Keeps the handle of the first device that is wanted.
void UsbDevice::look_at(libusb_device *device, Search *search)
{
	libusb_device_descriptor descriptor;
	if (libusb_get_device_descriptor(device, &descriptor) || descriptor.idVendor != PONG_TRIGGER_USB_VENDOR ||
	    descriptor.idProduct != PONG_TRIGGER_USB_PRODUCT)
		return;
	libusb_device_handle *handle;
	if (const int error = libusb_open(device, &handle)) {
		if (error == LIBUSB_ERROR_ACCESS)
			search->forbidden = format("/dev/bus/usb/%03d/%03d", libusb_get_bus_number(device),
						   libusb_get_device_address(device));
		return;
	}
	const std::string serial = string_of(handle, descriptor.iSerialNumber);
	if (string_of(handle, descriptor.iManufacturer) != PONG_TRIGGER_USB_MANUFACTURER ||
	    (!search->wanted.empty() && serial != search->wanted)) {
		libusb_close(handle);
		return;
	}
	search->found++;
	search->serials += (search->serials.empty() ? "" : ", ") + serial;
	if (handle_)
		libusb_close(handle);
	else
		handle_ = handle;
}

void UsbDevice::open(const std::string &serial)
{
	Search search;
	search.wanted = serial;
	libusb_device **devices;
	const ssize_t count = libusb_get_device_list(context_, &devices);
	for (ssize_t i = 0; i < count; i++)
		look_at(devices[i], &search);
	if (count >= 0)
		libusb_free_device_list(devices, 1);

	if (!search.found && !search.forbidden.empty())
		throw Failure("no permission for the trigger at " + search.forbidden +
			      ": install trigger/70-pongeye-trigger.rules and join its group");
	if (!search.found)
		throw Failure(serial.empty()
				      ? "no Pongeye trigger is plugged in"
				      : "no Pongeye trigger with the serial number '" + serial + "' is plugged in");
	if (search.found > 1)
		throw Failure(format("%d triggers are plugged in: choose one by its serial number (%s)", search.found,
				     search.serials.c_str()));
	if (const int error = libusb_claim_interface(handle_, INTERFACE))
		throw Failure(error == LIBUSB_ERROR_BUSY
				      ? "the trigger is in use by another program"
				      : std::string("cannot use the trigger: ") + libusb_strerror(error));
}

int UsbDevice::control(uint8_t direction, pong_trigger_request request, uint16_t value, void *data, size_t size)
{
	return libusb_control_transfer(handle_, direction | LIBUSB_REQUEST_TYPE_VENDOR, request, value, 0,
				       static_cast<unsigned char *>(data), static_cast<uint16_t>(size), PATIENCE_MS);
}

void UsbDevice::send(pong_trigger_request request, uint16_t value, const void *data, size_t size, const char *what)
{
	const int result = control(LIBUSB_ENDPOINT_OUT, request, value, const_cast<void *>(data), size);
	if (result == LIBUSB_ERROR_PIPE)
		throw Failure(std::string("the trigger refuses ") + what);
	if (result < 0)
		fail(result);
}

void UsbDevice::fetch(pong_trigger_request request, void *data, size_t size)
{
	const int result = control(LIBUSB_ENDPOINT_IN, request, 0, data, size);
	if (result >= 0 && static_cast<size_t>(result) != size)
		throw Failure("the trigger gives a short answer: its firmware is not of this version; make flash");
	if (result < 0)
		fail(result);
}

size_t UsbDevice::read_pulses(pong_trigger_pulse pulses[PONG_TRIGGER_PULSES_PER_PACKET], unsigned milliseconds)
{
	int size = 0;
	const int error = libusb_interrupt_transfer(
		handle_, PONG_TRIGGER_PULSE_ENDPOINT, reinterpret_cast<unsigned char *>(pulses),
		PONG_TRIGGER_PULSES_PER_PACKET * sizeof *pulses, &size, milliseconds);
	if (error && error != LIBUSB_ERROR_TIMEOUT && error != LIBUSB_ERROR_INTERRUPTED)
		fail(error);
	return static_cast<size_t>(size) / sizeof *pulses;
}

} // namespace pong
