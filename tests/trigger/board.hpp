// A board with the real firmware on it, in simavr: its pins seen from outside, its USB from the host's end of the
// cable.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

struct avr_t;
struct avr_irq_t;

enum Output { LEFT, RIGHT, LIGHT, OUTPUTS };

struct Edge {
	uint64_t cycle;
	bool level;
};

struct ControlRequest {
	uint8_t type, request;
	uint16_t value, index, length;
};

class Board
{
public:
	static constexpr int STALL = -1, TIMEOUT = -2;
	static constexpr double FREQUENCY = 16e6;

	// Runs the firmware until it attaches to the bus. Throws std::runtime_error where the file is none.
	explicit Board(const std::string &elf);
	~Board();
	Board(const Board &) = delete;
	Board &operator=(const Board &) = delete;

	void run(uint64_t cycles);
	uint64_t cycle() const;

	bool level(Output output) const;
	const std::vector<Edge> &edges(Output output) const;
	void forget_edges();
	void drive_start_input(bool level);

	// What a kernel does when the device is plugged in: reset, address, configuration.
	void enumerate();
	void reset_bus();
	// A control transfer. Data go out of or come into `data`, which has room for request.length bytes. Returns the
	// bytes transferred, STALL, or TIMEOUT.
	int control(const ControlRequest &request, void *data);
	// A control transfer that the host gives up after its SETUP packet.
	void abandon(const ControlRequest &request);
	// One packet of the pulse endpoint; 0 where it has none (NAK).
	int read_pulse_packet(uint8_t packet[64]);

private:
	struct Pin {
		Board *board;
		Output output;
	};
	static void on_pin(avr_irq_t *irq, uint32_t value, void *pin);
	static void on_attach(avr_irq_t *irq, uint32_t value, void *board);
	void watch(Output output, char port, int bit);
	void step();
	int transfer(uint32_t direction, uint8_t pipe, void *data, uint32_t *length);
	void send_setup(const ControlRequest &request);
	int read_data(uint8_t *data, int length);
	int write_data(const uint8_t *data, int length);

	avr_t *avr_;
	bool attached_ = false;
	Pin pins_[OUTPUTS];
	bool levels_[OUTPUTS] = {};
	std::vector<Edge> edges_[OUTPUTS];
};
