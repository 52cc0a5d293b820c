// usbip_device FIRMWARE PINS: plugs a board with the real firmware, in simavr, into this kernel's virtual USB host
// controller (vhci-hcd), and runs it at the clock's pace. The file PINS always holds one line:
//   RISES SHORTEST LONGEST LEFT RIGHT LIGHT
// rising edges of the left output, the periods between them in cycles, and the levels of the outputs.
//
// The messages are those of the kernel's Documentation/usb/usbip_protocol.rst: 48 bytes, big endian, then data.
#include <algorithm>
#include <arpa/inet.h>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <deque>
#include <fcntl.h>
#include <fstream>
#include <poll.h>
#include <stdexcept>
#include <string>
#include <sys/socket.h>
#include <unistd.h>
#include <vector>

#include "tests/trigger/board.hpp"

namespace
{

// Commands; what is not UNLINK is SUBMIT.
constexpr uint32_t UNLINK = 2, SUBMITTED = 3, UNLINKED = 4;
constexpr uint32_t FULL_SPEED = 2;
constexpr uint64_t SLICE = 16'000; // cycles between two looks at the socket

using Header = std::array<uint32_t, 12>;
enum Field {
	COMMAND,
	SEQUENCE,
	DEVICE,
	DIRECTION,
	ENDPOINT,
	STATUS = 5,
	LENGTH = 6,
	UNLINKED_SEQUENCE = 5,
	SETUP = 10
};

class Cable
{
public:
	Cable()
	{
		int ends[2];
		if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends))
			throw std::runtime_error("no socket pair");
		const std::string line = "0 " + std::to_string(ends[1]) + " 65538 " + std::to_string(FULL_SPEED);
		const int attach = open("/sys/devices/platform/vhci_hcd.0/attach", O_WRONLY);
		if (attach < 0 || write(attach, line.data(), line.size()) != static_cast<ssize_t>(line.size()))
			throw std::runtime_error(std::string("vhci_hcd does not attach: ") + strerror(errno));
		close(attach);
		close(ends[1]);
		socket_ = ends[0];
	}

	// Whether a message comes within so many milliseconds.
	bool has_message(int milliseconds) const
	{
		pollfd waiting = {socket_, POLLIN, 0};
		return poll(&waiting, 1, milliseconds) > 0;
	}

	// False where the kernel has pulled the cable.
	bool read(void *data, size_t size) const
	{
		return size == 0 || recv(socket_, data, size, MSG_WAITALL) == static_cast<ssize_t>(size);
	}

	void write_all(const std::vector<uint8_t> &data) const
	{
		if (send(socket_, data.data(), data.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(data.size()))
			throw std::runtime_error("the kernel does not listen");
	}

private:
	int socket_;
};

class Device
{
public:
	Device(const std::string &firmware, std::string pins) : board_(firmware), pins_(std::move(pins))
	{
		board_.reset_bus();
		tell_pins();
	}

	// Until the cable is pulled.
	void serve()
	{
		const double begin = seconds() - static_cast<double>(board_.cycle()) / Board::FREQUENCY;
		for (;;) {
			const double lag = (seconds() - begin) * Board::FREQUENCY - static_cast<double>(board_.cycle());
			if (cable_.has_message(lag > 0 ? 0 : 1) && !serve_message())
				return;
			if (lag > 0)
				board_.run(std::min(static_cast<uint64_t>(lag) + 1, SLICE));
			report_pulses();
			tell_pins();
		}
	}

private:
	struct Waiting {
		uint32_t sequence;
	};

	static double seconds()
	{
		timespec now;
		clock_gettime(CLOCK_MONOTONIC, &now);
		return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
	}

	bool serve_message()
	{
		Header header;
		if (!cable_.read(header.data(), sizeof header))
			return false;
		for (int i = 0; i < SETUP; i++)
			header[i] = ntohl(header[i]);
		if (header[COMMAND] == UNLINK)
			return unlink(header);
		std::vector<uint8_t> data(header[LENGTH]);
		if (!header[DIRECTION] && !cable_.read(data.data(), data.size()))
			return false;
		if (header[ENDPOINT] == 0)
			control(header, data);
		else
			waiting_.push_back({header[SEQUENCE]});
		return true;
	}

	bool unlink(const Header &header)
	{
		int32_t status = 0;
		for (auto urb = waiting_.begin(); urb != waiting_.end(); ++urb)
			if (urb->sequence == header[UNLINKED_SEQUENCE]) {
				waiting_.erase(urb);
				status = -ECONNRESET;
				break;
			}
		answer(UNLINKED, header[SEQUENCE], status, 0, {});
		return true;
	}

	void control(const Header &header, std::vector<uint8_t> data)
	{
		ControlRequest request;
		memcpy(&request, &header[SETUP], sizeof request);
		data.resize(std::max<size_t>(request.length, 1));
		const int done = board_.control(request, data.data());
		const int32_t status = done == Board::STALL ? -EPIPE : done < 0 ? -ETIMEDOUT : 0;
		const uint32_t length = done > 0 ? static_cast<uint32_t>(done) : 0;
		data.resize(header[DIRECTION] ? length : 0);
		answer(SUBMITTED, header[SEQUENCE], status, length, data);
	}

	void report_pulses()
	{
		uint8_t packet[64];
		while (!waiting_.empty()) {
			const int size = board_.read_pulse_packet(packet);
			if (!size)
				return;
			answer(SUBMITTED, waiting_.front().sequence, 0, static_cast<uint32_t>(size),
			       std::vector<uint8_t>(packet, packet + size));
			waiting_.pop_front();
		}
	}

	void answer(uint32_t command, uint32_t sequence, int32_t status, uint32_t length,
		    const std::vector<uint8_t> &data)
	{
		Header header = {};
		header[COMMAND] = htonl(command);
		header[SEQUENCE] = htonl(sequence);
		header[STATUS] = htonl(static_cast<uint32_t>(status));
		if (command == SUBMITTED) {
			header[LENGTH] = htonl(length);
			header[8] = 0xffffffff; // not isochronous
		}
		std::vector<uint8_t> message(sizeof header);
		memcpy(message.data(), header.data(), sizeof header);
		message.insert(message.end(), data.begin(), data.end());
		cable_.write_all(message);
	}

	// Only where an edge has come since the last time.
	void tell_pins()
	{
		const std::vector<Edge> &edges = board_.edges(LEFT);
		for (; seen_ < edges.size(); seen_++) {
			if (!edges[seen_].level)
				continue;
			const uint64_t period = edges[seen_].cycle - last_rise_;
			if (rises_++) {
				shortest_ = std::min(shortest_, period);
				longest_ = std::max(longest_, period);
			}
			last_rise_ = edges[seen_].cycle;
		}
		const std::string line = std::to_string(rises_) + " " + std::to_string(shortest_) + " " +
					 std::to_string(longest_) + " " + std::to_string(board_.level(LEFT)) + " " +
					 std::to_string(board_.level(RIGHT)) + " " +
					 std::to_string(board_.level(LIGHT)) + "\n";
		if (line != told_)
			std::ofstream(pins_) << line;
		told_ = line;
	}

	Board board_;
	std::string pins_, told_;
	Cable cable_;
	std::deque<Waiting> waiting_; // requests for pulses
	size_t seen_ = 0;
	uint64_t rises_ = 0, last_rise_ = 0, shortest_ = UINT64_MAX, longest_ = 0;
};

} // namespace

int main(int argc, char **argv)
{
	if (argc != 3) {
		fprintf(stderr, "usage: %s FIRMWARE PINS\n", argv[0]);
		return 2;
	}
	try {
		Device(argv[1], argv[2]).serve();
	} catch (const std::exception &error) {
		fprintf(stderr, "%s: %s\n", argv[0], error.what());
		return 1;
	}
	return 0;
}
