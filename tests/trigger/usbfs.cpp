#include "usbfs.hpp"

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <linux/usbdevice_fs.h>
#include <stdexcept>
#include <sys/ioctl.h>

namespace
{

constexpr uint64_t MILLISECOND = 16'000; // cycles

const char *const DEVICE = "P: /devices/usb1/1-1\nN: bus/usb/001/002\nE: BUSNUM=001\nE: DEVNUM=002\n"
			   "E: DEVNAME=/dev/bus/usb/001/002\nE: DEVTYPE=usb_device\nE: SUBSYSTEM=usb\n"
			   "A: busnum=1\\n\nA: devnum=2\\n\nA: speed=12\\n\nA: bConfigurationValue=1\\n\n"
			   "A: idVendor=1209\\n\nA: idProduct=0001\\n\n";

template<typename Value> void update(UMockdevIoctlData *data, size_t offset, Value value)
{
	umockdev_ioctl_data_update(data, offset, reinterpret_cast<guint8 *>(&value), sizeof value);
}

} // namespace

Usbfs::Usbfs(Board *board, UMockdevTestbed *testbed) : board_(board), handler_(umockdev_ioctl_base_new())
{
	uint8_t descriptors[18 + 64];
	board_->enumerate();
	const int device = board_->control({0x80, 6, 0x0100, 0, 18}, descriptors);
	const int configuration = board_->control({0x80, 6, 0x0200, 0, 64}, descriptors + 18);
	if (device != 18 || configuration < 0)
		throw std::runtime_error("the board gives no descriptors");
	GError *error = nullptr;
	if (!umockdev_testbed_add_from_string(testbed, DEVICE, &error))
		throw std::runtime_error(error->message);
	umockdev_testbed_set_attribute_binary(testbed, "/sys/devices/usb1/1-1", "descriptors", descriptors,
					      device + configuration);
	g_signal_connect(handler_, "handle-ioctl", G_CALLBACK(on_ioctl), this);
	if (!umockdev_testbed_attach_ioctl(testbed, "/dev/bus/usb/001/002", handler_, &error))
		throw std::runtime_error(error->message);
}

Usbfs::~Usbfs()
{
	g_object_unref(handler_);
}

int Usbfs::on_ioctl(UMockdevIoctlBase *, UMockdevIoctlClient *client, void *self)
{
	static_cast<Usbfs *>(self)->answer(client);
	return TRUE;
}

void Usbfs::answer(UMockdevIoctlClient *client)
{
	UMockdevIoctlData *argument = umockdev_ioctl_client_get_arg(client);
	on_request();
	int error = 0;
	switch (static_cast<unsigned>(umockdev_ioctl_client_get_request(client))) {
	case USBDEVFS_GET_CAPABILITIES: {
		const uint32_t capabilities = USBDEVFS_CAP_BULK_CONTINUATION | USBDEVFS_CAP_NO_PACKET_SIZE_LIM;
		UMockdevIoctlData *word = umockdev_ioctl_data_resolve(argument, 0, sizeof capabilities, nullptr);
		update(word, 0, capabilities);
		break;
	}
	case USBDEVFS_CLAIMINTERFACE:
	case USBDEVFS_RELEASEINTERFACE:
		error = plugged_ ? 0 : ENODEV;
		break;
	case USBDEVFS_SUBMITURB:
		error = submit(argument);
		break;
	case USBDEVFS_REAPURB:
	case USBDEVFS_REAPURBNDELAY:
		error = reap(argument);
		break;
	case USBDEVFS_DISCARDURB:
		error = discard(argument);
		break;
	default:
		error = ENOTTY;
	}
	on_time();
	umockdev_ioctl_client_complete(client, error ? -1 : 0, error);
}

int Usbfs::submit(UMockdevIoctlData *argument)
{
	if (!plugged_)
		return ENODEV;
	UMockdevIoctlData *data = umockdev_ioctl_data_resolve(argument, 0, sizeof(usbdevfs_urb), nullptr);
	usbdevfs_urb wanted;
	memcpy(&wanted, data->data, sizeof wanted);
	UMockdevIoctlData *buffer =
		umockdev_ioctl_data_resolve(data, offsetof(usbdevfs_urb, buffer), wanted.buffer_length, nullptr);
	Urb urb = {static_cast<UMockdevIoctlData *>(g_object_ref(data)),
		   buffer,
		   wanted.type,
		   wanted.endpoint,
		   wanted.buffer_length,
		   0,
		   0,
		   data->client_addr};
	if (urb.type == USBDEVFS_URB_TYPE_CONTROL)
		run_control(&urb);
	else
		waiting_.push_back(urb);
	return 0;
}

void Usbfs::run_control(Urb *urb)
{
	ControlRequest request;
	memcpy(&request, urb->buffer->data, sizeof request);
	std::vector<uint8_t> data(urb->buffer->data + sizeof request, urb->buffer->data + urb->length);
	data.resize(data.size() + 1); // never empty
	const int done = board_->control(request, data.data());
	if (done >= 0 && (request.type & 0x80)) {
		on_reply(request, data.data());
		umockdev_ioctl_data_update(urb->buffer, sizeof request, data.data(), done);
	}
	urb->actual = done > 0 ? done : 0;
	finish(*urb, done == Board::STALL ? -EPIPE : done < 0 ? -ETIMEDOUT : 0);
}

void Usbfs::finish(Urb urb, int status)
{
	urb.status = status;
	done_.push_back(urb);
}

void Usbfs::poll_pulses()
{
	board_->run(MILLISECOND);
	uint8_t packet[64];
	const int size = board_->read_pulse_packet(packet);
	if (!size)
		return;
	Urb urb = waiting_.front();
	waiting_.pop_front();
	umockdev_ioctl_data_update(urb.buffer, 0, packet, size);
	urb.actual = size;
	finish(urb, 0);
}

int Usbfs::reap(UMockdevIoctlData *argument)
{
	if (done_.empty() && !waiting_.empty())
		poll_pulses();
	if (done_.empty())
		return plugged_ ? EAGAIN : ENODEV;
	const Urb urb = done_.front();
	done_.pop_front();
	update(urb.urb, offsetof(usbdevfs_urb, status), urb.status);
	update(urb.urb, offsetof(usbdevfs_urb, actual_length), urb.actual);
	UMockdevIoctlData *place = umockdev_ioctl_data_resolve(argument, 0, sizeof(void *), nullptr);
	umockdev_ioctl_data_set_ptr(place, 0, urb.urb);
	g_object_unref(urb.urb);
	return 0;
}

int Usbfs::discard(UMockdevIoctlData *argument)
{
	const unsigned long address = *reinterpret_cast<unsigned long *>(argument->data);
	for (auto urb = waiting_.begin(); urb != waiting_.end(); ++urb)
		if (urb->address == address) {
			finish(*urb, -ENOENT);
			waiting_.erase(urb);
			return 0;
		}
	return EINVAL;
}

// The kernel gives back whatever was under way, and refuses the rest.
void Usbfs::unplug()
{
	plugged_ = false;
	for (const Urb &urb : waiting_)
		finish(urb, -ESHUTDOWN);
	waiting_.clear();
}
