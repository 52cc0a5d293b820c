// The control channel of one camera: GVCP commands in, replies out, and what the client wants in between. It does no
// input or output and reads no clock, so that any bytes at any time can be tried on it.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <optional>

#include "gvcp.hpp"
#include "power_on.hpp"
#include "registers.hpp"
#include "stream.hpp"

namespace gige
{

// What a command leads to.
struct Answer {
	Bytes reply;               // to the sender; empty: none
	std::vector<Bytes> stream; // packets to the stream's destination
	Endpoint destination;
};

// What the client wants of the sensor: one consistent copy.
struct Acquisition {
	uint64_t changes = 0; // so far
	uint64_t session = 0; // another number after every start; 0: not streaming
	bool is_triggered = false, by_line = false;
	uint64_t software_triggers = 0; // since the start
	double frame_rate = 0;          // Hz, where not triggered
	double exposure = 0;            // s
	double gain = 0;                // dB
	Region region;
	bool has_chunks = false, is_single_frame = false;
	size_t packet_size = 0;
	int64_t packet_delay = 0; // ns
	Endpoint destination;
};

// For several threads at once.
class Control
{
public:
	Control(const ControlSettings &settings, const FrameRing &ring);

	// A datagram from the control port; times are CLOCK_MONOTONIC, ns.
	Answer handle(const uint8_t *bytes, size_t size, const Endpoint &from, int64_t now);

	// The same from the broadcast address, to which only discovery is an answer.
	Bytes discover(const uint8_t *bytes, size_t size) const;

	// Take control away from a client that has been silent for longer than its heartbeat timeout.
	void check_heartbeat(int64_t now);

	// As if a client had taken control just now, that will not be heard of again.
	void leave_held(int64_t now);

	// The camera's clock is ahead by so much from now on, ns.
	void set_clock_step(int64_t step)
	{
		clock_step_ = step;
	}

	bool is_controlled() const;
	Acquisition acquisition() const;
	void set_stream_source_port(uint16_t port);

	// End the acquisition from the camera's side, unless it's another one by now.
	void finish(uint64_t session);

	// Wait until `time`. False, at once, when the session is no longer what the client wants.
	bool wait_in_session(int64_t time, uint64_t session);

	// Wait until the client or notify() has changed something since `seen`; at most until `time`.
	void wait_for_change(int64_t time, const Acquisition &seen);
	void notify();

	uint64_t device_time(int64_t time) const;

private:
	// Where a write comes from, and where what it leads to goes.
	struct Writing {
		const Endpoint &from;
		int64_t now;
		Answer &answer;
	};

	Status execute(const Request &request, const Writing &writing, Bytes &data);
	Status read_registers(const Request &request, Bytes &data) const;
	Status read_memory(const Request &request, Bytes &data) const;
	Status write_registers(const Request &request, const Writing &writing, Bytes &data);
	Status write_memory(const Request &request, const Writing &writing, Bytes &data);
	Status resend(const Request &request, const Writing &writing) const;

	Status write(uint32_t address, uint32_t value, const Writing &writing);
	Status check(uint32_t address, uint32_t value) const;
	void take_effect(uint32_t address, uint32_t value, const Writing &writing);
	void set_privilege(uint32_t privilege, const Writing &writing);
	void fire_test_packet(Answer &answer);
	void start();
	void stop();
	void release();
	void notify_change();

	void expire(int64_t now);
	bool may_read(const Endpoint &from) const;
	Region region() const;
	Endpoint destination() const;

	const ControlSettings settings_;
	const FrameRing &ring_;
	std::atomic<int64_t> clock_step_ = 0;

	mutable std::mutex mutex_; // guards all that follows
	std::condition_variable change_;
	RegisterFile registers_;
	std::optional<Endpoint> controller_;
	int64_t heard_ = 0; // of the controller, ns
	uint64_t session_ = 0, sessions_ = 0, changes_ = 0, software_triggers_ = 0;
};

} // namespace gige
