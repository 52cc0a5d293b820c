// The board as a device file of Linux' usbfs, for programs that run under umockdev: what the kernel would do between
// libusb and the cable. Emulated time passes only while a program waits for the device.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <umockdev.h>
#include <vector>

#include "board.hpp"

class Usbfs
{
public:
	// Plugs the board in: enumerated, in /sys and at /dev/bus/usb/001/002.
	Usbfs(Board *board, UMockdevTestbed *testbed);
	~Usbfs();
	Usbfs(const Usbfs &) = delete;
	Usbfs &operator=(const Usbfs &) = delete;

	// Every request from now on fails as after a pull of the cable.
	void unplug();

	std::function<void()> on_request = [] {}; // before a request is looked at
	std::function<void()> on_time = [] {};    // whenever emulated time has passed
	std::function<void(const ControlRequest &, uint8_t *)> on_reply = [](auto &, auto *) {}; // may change a reply

private:
	struct Urb {
		UMockdevIoctlData *urb, *buffer;
		uint8_t type, endpoint;
		int length, status, actual;
		unsigned long address;
	};
	static int on_ioctl(UMockdevIoctlBase *, UMockdevIoctlClient *client, void *self);
	void answer(UMockdevIoctlClient *client);
	int submit(UMockdevIoctlData *argument);
	int reap(UMockdevIoctlData *argument);
	int discard(UMockdevIoctlData *argument);
	void run_control(Urb *urb);
	void poll_pulses();
	void finish(Urb urb, int status);

	Board *board_;
	UMockdevIoctlBase *handler_;
	std::deque<Urb> waiting_, done_;
	bool plugged_ = true;
};
