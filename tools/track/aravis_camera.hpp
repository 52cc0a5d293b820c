// One camera by Aravis: found, set up, and streaming, with its clock mapped to the host's.
#pragma once

#include <arv.h>
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "capture_settings.hpp"
#include "clock.hpp"
#include "object.hpp"
#include "pairing.hpp"
#include "pongeye.h"
#include "program.hpp"
#include "pulse_counter.hpp"
#include "punctuality.hpp"
#include "still.hpp"
#include "ticker.hpp"

namespace track
{

// The camera is not there, or not to be had just now: it may come.
struct Absent : pong::Failure {
	using pong::Failure::Failure;
};

// Pictures that came and were not taken.
struct CaptureCounts {
	std::atomic<int64_t> incomplete{0}, late{0}, repeated{0}, undated{0};
};

class Camera
{
public:
	// What to do with a complete picture; called in the camera's own thread. Its buffer is an ArvBuffer, to be
	// given back. Returns false where it cannot be taken: then it is dropped.
	using Receive = std::function<bool(pong_side side, const Picture &picture)>;

	// Finds the camera, sets it up, and starts it. `number`: of this camera among all that were opened, which its
	// buffers bear. `counts` is added to. Throws Absent, or pong::Failure where the camera cannot do what the
	// settings ask for.
	Camera(pong_side side, const pong_camera &camera, const CaptureSettings &settings, int number,
	       CaptureCounts &counts, Receive receive);

	// Ends the stream: from then on nothing is received. Buffers not given back are to be freed. Of a camera that
	// was given up nothing is asked any more but its control back.
	~Camera();

	Camera(const Camera &) = delete;
	Camera &operator=(const Camera &) = delete;

	void give_up()
	{
		lost_ = true;
	}

	void give_back(void *buffer);

	// Have its clock compared before the next picture is believed.
	void doubt_clock()
	{
		clock_doubted_ = true;
	}

	// Aravis says that the camera no longer answers, or that another program has taken it.
	bool lost() const
	{
		return lost_;
	}

	// When the last picture came, whole or not; at first when the camera started. By monotonic_ns().
	int64_t last_sign_ns() const
	{
		return last_sign_ns_;
	}

	// Its last pictures were one and the same.
	bool frozen() const
	{
		return repeats_ > 0;
	}

	int64_t exposure_ns() const
	{
		return exposure_ns_;
	}

	// Its IPv4 address; none of a USB3 Vision camera.
	std::optional<uint32_t> address() const;

private:
	void open(const char *id);
	void start();
	std::optional<ClockReading> latch_clock();
	void read_clock(int tries);
	// A setting, and between what the camera can have it.
	struct Wish {
		const char *what;
		double value, least, most;
		const char *unit;
	};

	void set_picture(const pong_camera &camera, const CaptureSettings &settings);
	void check_limits(const Wish &wish) const;
	void check_rate(double exposure, double rate) const;
	void set_exposure(const CaptureSettings &settings);
	void set_trigger(const CaptureSettings &settings);
	void set_ptp(const CaptureSettings &settings);
	void set_packets(const CaptureSettings &settings);
	void find_clock();
	void open_stream();
	static void on_stream(void *camera, ArvStreamCallbackType event, ArvBuffer *buffer);
	void receive_buffer();
	void hand_on(ArvBuffer *buffer, int64_t arrival_ns);
	bool is_whole(void *buffer) const;
	int64_t dated_by_clock(ArvBuffer *buffer);
	std::optional<int64_t> exposure_begin_ns(ArvBuffer *buffer);

	pong_side side_;
	std::string name_;
	int number_;
	int width_, height_;
	Receive receive_;
	Object<ArvCamera> camera_;
	std::mutex features_mutex_; // to be held by who asks the camera for anything once it sends pictures
	int64_t exposure_ns_ = 0;
	bool has_clock_ = false;
	std::mutex clock_mutex_;
	ClockFit clock_;
	int64_t clock_set_ns_ = INT64_MIN / 2; // when that was noticed, by monotonic_ns()
	int64_t clock_error_ns_ = INT64_MAX;   // at most, of the best reading
	PulseCounter counter_;
	std::atomic<bool> lost_{false}, clock_doubted_{false};
	std::atomic<int64_t> last_sign_ns_{0};
	std::atomic<int> repeats_{0};
	Still still_;
	Punctuality punctuality_;
	CaptureCounts &counts_;
	std::unique_ptr<Ticker> clock_reader_;
	Object<ArvStream> stream_; // ends before all the rest, which its thread uses
};

// "left camera 192.168.1.10"
std::string camera_name(pong_side side, const pong_camera &camera);

// What a picture's buffer holds.
pong_image image_of(void *buffer);

// The number of the camera that a buffer came from.
int camera_of(void *buffer);

// For a buffer whose camera has ended.
void free_buffer(void *buffer);

} // namespace track
