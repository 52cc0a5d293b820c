// One camera's place in the rig. Whatever happens to the camera, the place stays: a thread of its own waits for the
// camera, opens it, watches it, lets go of it when it is lost, and waits for it again.
#pragma once

#include <atomic>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "aravis_camera.hpp"
#include "presence.hpp"
#include "source.hpp"

namespace track
{

class Seat
{
public:
	// `receive` is called in the camera's thread.
	Seat(pong_side side, const pong_camera &camera, const CaptureSettings &settings, Camera::Receive receive);
	~Seat();
	Seat(const Seat &) = delete;
	Seat &operator=(const Seat &) = delete;

	// Begin to end, without waiting for it.
	void begin_to_end();

	// To the camera that it came from, where that is still open; else it is freed.
	void give_back(void *buffer);

	// A picture of this camera should have come, because the trigger ran: look after it at once.
	void suspect();

	// Have the camera's clock compared before its next picture is believed.
	void doubt_clock();

	CameraState state() const;

	// When the last picture came, whole or not, by monotonic_ns(); none where no camera is open.
	std::optional<int64_t> last_sign_ns() const;

	int64_t exposure_ns() const
	{
		return exposure_ns_;
	}

	const CaptureCounts &counts() const
	{
		return counts_;
	}

	int64_t losses() const
	{
		return losses_;
	}

	// Throws where the camera cannot do what rig.toml asks for, which waiting does not change.
	void check() const;

private:
	enum class Verdict { WELL, QUIET, LOST };

	void keep();
	bool wait_for_camera();
	bool open();
	void watch();
	Verdict examine(Camera &camera, bool suspected);
	void close();
	bool sleep(std::chrono::milliseconds time);
	void tell(const std::string &sentence);

	const pong_side side_;
	const pong_camera settings_camera_;
	const CaptureSettings settings_;
	const Camera::Receive receive_;
	const std::string name_;
	std::optional<uint32_t> address_; // once it is known
	CaptureCounts counts_;
	std::atomic<int64_t> exposure_ns_{0}, losses_{0};
	int opened_ = 0;
	std::string told_;      // the last sentence
	const char *loss_ = ""; // why examine() takes the camera for lost

	mutable std::mutex mutex_; // guards what follows
	std::condition_variable wake_;
	std::unique_ptr<Camera> camera_;
	bool stop_ = false, suspected_ = false, quiet_ = false;
	std::exception_ptr refusal_;

	std::thread closer_; // lets go of the camera that was lost last
	std::thread keeper_;
};

} // namespace track
