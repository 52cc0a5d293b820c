#include "board.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include <simavr/avr_ioport.h>
#include <simavr/avr_usb.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_core.h>
#include <simavr/sim_elf.h>
#include <simavr/sim_interrupts.h>

namespace
{

constexpr uint64_t PATIENCE = 8'000'000; // cycles that a host waits for an answer: 0.5 s
constexpr uint32_t PACKET = 64;

} // namespace

Board::Board(const std::string &elf)
{
	elf_firmware_t firmware = {};
	if (elf_read_firmware(elf.c_str(), &firmware))
		throw std::runtime_error(elf + ": no firmware");
	strcpy(firmware.mmcu, "atmega32u4");
	firmware.frequency = static_cast<uint32_t>(FREQUENCY);
	avr_ = avr_make_mcu_by_name(firmware.mmcu);
	avr_init(avr_);
	avr_->log = LOG_ERROR;
	avr_load_firmware(avr_, &firmware);

	watch(LEFT, 'B', 5);
	watch(RIGHT, 'B', 6);
	watch(LIGHT, 'C', 6);
	avr_irq_register_notify(avr_io_getirq(avr_, AVR_IOCTL_USB_GETIRQ(), USB_IRQ_ATTACH), on_attach, this);
	while (!attached_ && avr_->cycle < PATIENCE)
		step();
	if (!attached_)
		throw std::runtime_error(elf + ": never attaches to the bus");
	drive_start_input(true);
}

Board::~Board()
{
	avr_terminate(avr_);
}

void Board::watch(Output output, char port, int bit)
{
	pins_[output] = {this, output};
	avr_irq_register_notify(avr_io_getirq(avr_, AVR_IOCTL_IOPORT_GETIRQ(port), bit), on_pin, &pins_[output]);
}

void Board::on_pin(avr_irq_t *, uint32_t value, void *param)
{
	const Pin *pin = static_cast<Pin *>(param);
	Board *board = pin->board;
	const bool level = value & 1;
	if (board->levels_[pin->output] == level)
		return;
	board->levels_[pin->output] = level;
	board->edges_[pin->output].push_back({board->avr_->cycle, level});
}

void Board::on_attach(avr_irq_t *, uint32_t value, void *board)
{
	static_cast<Board *>(board)->attached_ = value;
}

// avr_run() lets the timers catch up after each instruction, up to 5 cycles late, and then forgets a comparator whose
// value is smaller than that. Here each timer runs at its own cycle.
void Board::step()
{
	const avr_flashaddr_t pc = avr_run_one(avr_);
	const avr_cycle_count_t end = avr_->cycle;
	while (avr_->cycle_timers.timer && avr_->cycle_timers.timer->when <= end) {
		avr_->cycle = avr_->cycle_timers.timer->when;
		avr_cycle_timer_process(avr_);
	}
	avr_->cycle = end;
	avr_->pc = pc;
	if (avr_->state != cpu_Running)
		throw std::runtime_error("the firmware has crashed");
	avr_service_interrupts(avr_);
}

void Board::run(uint64_t cycles)
{
	const uint64_t end = avr_->cycle + cycles;
	while (avr_->cycle < end)
		step();
}

uint64_t Board::cycle() const
{
	return avr_->cycle;
}

bool Board::level(Output output) const
{
	return levels_[output];
}

const std::vector<Edge> &Board::edges(Output output) const
{
	return edges_[output];
}

void Board::forget_edges()
{
	for (std::vector<Edge> &edges : edges_)
		edges.clear();
}

void Board::drive_start_input(bool level)
{
	avr_raise_irq(avr_io_getirq(avr_, AVR_IOCTL_IOPORT_GETIRQ('D'), 4), level);
}

void Board::reset_bus()
{
	avr_ioctl(avr_, AVR_IOCTL_USB_RESET, nullptr);
	run(16000);
}

void Board::enumerate()
{
	uint8_t descriptor[18];
	reset_bus();
	const bool good = control({0x80, 6, 0x0100, 0, sizeof descriptor}, descriptor) == sizeof descriptor &&
			  control({0x00, 5, 7, 0, 0}, nullptr) == 0 && control({0x00, 9, 1, 0, 0}, nullptr) == 0;
	if (!good)
		throw std::runtime_error("the firmware cannot be enumerated");
}

// A packet in either direction; the device may answer NAK for a while.
int Board::transfer(uint32_t direction, uint8_t pipe, void *data, uint32_t *length)
{
	for (const uint64_t end = avr_->cycle + PATIENCE; avr_->cycle < end; run(64)) {
		avr_io_usb packet = {pipe, *length, static_cast<uint8_t *>(data)};
		const int result = avr_ioctl(avr_, direction, &packet);
		if (result == AVR_IOCTL_USB_STALL)
			return STALL;
		if (result == AVR_IOCTL_USB_OK) {
			*length = packet.sz;
			return 0;
		}
	}
	return TIMEOUT;
}

// As a host would, it sends again where the device has not taken the packet. simavr itself fills the FIFO at once, so
// the previous transfer must have left the device's program first.
void Board::send_setup(const ControlRequest &request)
{
	uint8_t bytes[8];
	memcpy(bytes, &request, sizeof bytes);
	avr_io_usb packet = {0, sizeof bytes, bytes};
	avr_ioctl(avr_, AVR_IOCTL_USB_SETUP, &packet);
	run(1600);
}

int Board::read_data(uint8_t *data, int length)
{
	int got = 0;
	while (got < length) {
		uint8_t packet[PACKET];
		uint32_t size = PACKET;
		if (const int error = transfer(AVR_IOCTL_USB_READ, 0x80, packet, &size))
			return error;
		const int useful = std::min(static_cast<int>(size), length - got);
		memcpy(data + got, packet, useful);
		got += useful;
		if (size < PACKET)
			break;
	}
	return got;
}

int Board::write_data(const uint8_t *data, int length)
{
	for (int sent = 0; sent < length;) {
		uint8_t packet[PACKET];
		uint32_t size = std::min<uint32_t>(PACKET, length - sent);
		memcpy(packet, data + sent, size);
		if (const int error = transfer(AVR_IOCTL_USB_WRITE, 0x00, packet, &size))
			return error;
		sent += static_cast<int>(size);
	}
	return length;
}

int Board::control(const ControlRequest &request, void *data)
{
	const bool in = (request.type & 0x80) && request.length;
	uint8_t *bytes = static_cast<uint8_t *>(data), nothing[PACKET];
	send_setup(request);
	const int done = in ? read_data(bytes, request.length) : write_data(bytes, request.length);
	if (done < 0)
		return done;
	uint32_t none = 0;
	const int error = in ? transfer(AVR_IOCTL_USB_WRITE, 0x00, nothing, &none)
			     : transfer(AVR_IOCTL_USB_READ, 0x80, nothing, &none);
	run(800);
	return error ? error : done;
}

void Board::abandon(const ControlRequest &request)
{
	send_setup(request);
}

int Board::read_pulse_packet(uint8_t packet[64])
{
	avr_io_usb data = {0x81, PACKET, packet};
	return avr_ioctl(avr_, AVR_IOCTL_USB_READ, &data) == AVR_IOCTL_USB_OK ? static_cast<int>(data.sz) : 0;
}
