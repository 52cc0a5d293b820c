// One camera by Aravis: found, set up, and streaming, with its clock mapped to the host's.
#pragma once

#include <arv.h>
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "capture_settings.hpp"
#include "clock.hpp"
#include "pairing.hpp"
#include "pongeye.h"

namespace track
{

struct ObjectDeleter {
	void operator()(gpointer object) const
	{
		g_object_unref(object);
	}
};
template<class T> using Object = std::unique_ptr<T, ObjectDeleter>;

class Camera
{
public:
	// What to do with a complete picture; called in the camera's own thread. Its buffer is an ArvBuffer, to be
	// given back. Returns false where it cannot be taken: then it is dropped.
	using Receive = std::function<bool(pong_side side, const Picture &picture)>;

	// Finds the camera and sets it up. Throws pong::Failure.
	Camera(pong_side side, const pong_camera &camera, const CaptureSettings &settings, Receive receive);

	// Ends the stream: from then on nothing is received. Buffers not given back are to be freed.
	~Camera();

	Camera(const Camera &) = delete;
	Camera &operator=(const Camera &) = delete;

	void start();

	void give_back(void *buffer);

	// Compare the camera's clock with the host's; does nothing where the camera cannot.
	void read_clock();

	// The camera no longer answers, or another program has taken it.
	bool lost() const
	{
		return lost_;
	}

	int64_t incomplete() const
	{
		return incomplete_;
	}

	int64_t exposure_ns() const
	{
		return exposure_ns_;
	}

	// Pictures that were not taken.
	int64_t late() const
	{
		return late_;
	}

	// "left camera 192.168.1.10"
	const std::string &name() const
	{
		return name_;
	}

private:
	void open(const char *id);
	void set_picture(const pong_camera &camera);
	void set_exposure(const CaptureSettings &settings);
	void set_trigger(const CaptureSettings &settings);
	void set_packets(const CaptureSettings &settings);
	void find_clock();
	void open_stream();
	static void on_stream(void *camera, ArvStreamCallbackType event, ArvBuffer *buffer);
	void receive_buffer();
	int64_t exposure_begin_ns(ArvBuffer *buffer);

	pong_side side_;
	std::string name_;
	Receive receive_;
	Object<ArvCamera> camera_;
	Object<ArvStream> stream_;
	int64_t exposure_ns_ = 0;
	bool has_clock_ = false;
	std::mutex clock_mutex_;
	ClockFit clock_;
	std::atomic<bool> lost_{false};
	std::atomic<int64_t> incomplete_{0}, late_{0};
};

// Real-time priority for the calling thread; where the user may not have it, it is said once, and all goes on.
void make_thread_realtime(int priority);

// What a picture's buffer holds.
pong_image image_of(void *buffer);

// For a buffer whose camera has ended.
void free_buffer(void *buffer);

} // namespace track
