// One camera: a control channel, a sensor that is exposed by the trigger line (or runs freely), and the stream that
// its pictures leave on.
#pragma once

#include <atomic>
#include <memory>
#include <thread>

#include "control.hpp"
#include "server.hpp"
#include "trigger_line.hpp"
#include "udp_socket.hpp"
#include "wire.hpp"

namespace gige
{

// A flood of datagrams must not keep the rest of the server from its work.
constexpr int datagrams_a_round = 64;

class Camera
{
public:
	Camera(const ServerSettings &settings, int index, const TriggerLine &line, PictureSource &source);
	~Camera();

	// Switch it on where its faults let it have power, and off where they do not. While on it exposes, in a thread
	// of its own; nothing is left of what a client set before it was off.
	void keep_power();
	void power_down();

	bool is_on() const
	{
		return is_on_;
	}

	// Only while it is on.
	Control &control()
	{
		return *control_;
	}

	// Follow the clock's faults.
	void keep_clock();

	CameraCounts counts() const
	{
		return {pictures_, missed_};
	}

	// Answer whatever has come to the control port, and where to wait for it.
	void serve();
	int control_descriptor() const
	{
		return control_socket_.descriptor();
	}

	// Answer a discovery command from the broadcast address.
	void answer_discovery(const Bytes &datagram, const Endpoint &from);

private:
	// One exposure to be: when it begins, and which pulse's picture it is.
	struct Shot {
		int64_t start; // ns of CLOCK_MONOTONIC
		int64_t pulse;
		bool is_by_line;
		bool can_wait; // for its picture, however long it takes to render
	};

	void power_up();
	void expose_pictures();
	std::optional<Shot> plan(const Acquisition &acquisition);
	std::optional<Shot> plan_by_line(int64_t earliest) const;
	std::optional<Shot> plan_by_software(const Acquisition &acquisition);
	Shot plan_free(const Acquisition &acquisition, int64_t earliest) const;
	bool is_to_miss(const Shot &shot);
	void miss(const Shot &shot, const Acquisition &acquisition);
	void begin_session(const Acquisition &acquisition);
	void take(const Shot &shot, const Acquisition &acquisition);
	void render(const Shot &shot, const Acquisition &acquisition);
	const Frame &compose(const Shot &shot, const Acquisition &acquisition);
	void crop(const Region &region);
	void stream(const Frame &frame, const Acquisition &acquisition);

	const int index_;
	const int width_, height_; // of the sensor, px
	const double link_rate_;   // bit/s
	const int miss_every_;     // 0: misses no trigger
	const bool is_outside_;    // whether the line's pulses are known when they have come, not before
	ControlSettings control_settings_;
	const TriggerLine &line_;
	PictureSource &source_;
	const UdpSocket control_socket_, stream_socket_;
	Faults faults_;
	Wire wire_;
	FrameRing ring_;
	std::unique_ptr<Control> control_;
	std::optional<int64_t> dead_until_; // ns; since it has had no power

	std::atomic<bool> is_on_ = false;
	std::atomic<int64_t> pictures_ = 0, missed_ = 0;
	std::thread thread_;

	// Of the thread alone.
	Bytes pixels_;
	Frame frame_;
	Bytes datagram_;
	uint64_t session_ = 0;
	uint64_t software_triggers_ = 0; // that have been taken
	uint16_t frame_id_ = 0;
	int64_t session_begin_ = 0;
	int64_t sensor_free_ = 0; // when the sensor can be exposed again, ns
	int64_t render_time_ = 0; // that a picture takes, of late, ns
};

} // namespace gige
