#include "seat.hpp"

#include <utility>

#include "clock.hpp"

namespace track
{

namespace
{

using namespace std::chrono_literals;

constexpr auto SEARCH_INTERVAL = 50ms;            // between questions whether a camera is there
constexpr int TRIES_AT_OLD_ADDRESS = 40;          // of those: 6 s
constexpr auto ANSWER_PATIENCE = 100ms;           // with the answer
constexpr auto RETRY_INTERVAL = 300ms;            // after a camera that could not be opened
constexpr auto WATCH_INTERVAL = 50ms;             // between looks at an open one
constexpr auto SUSPECTED_PATIENCE = 90ms;         // with a camera whose pictures should have come
constexpr auto IDLE_PATIENCE = 1000ms;            // with one that waits for its trigger
constexpr int64_t IDLE_NS = INT64_C(1000000000);  // without pictures: then it is asked whether it is still there
constexpr int64_t RECENT_NS = INT64_C(100000000); // a picture so young says that the camera is well

} // namespace

Seat::Seat(pong_side side, const pong_camera &camera, const CaptureSettings &settings, Camera::Receive receive)
	: side_(side), settings_camera_(camera), settings_(settings), receive_(std::move(receive)),
	  name_(camera_name(side, camera)), address_(parse_address(camera.id)), keeper_([this] { keep(); })
{
}

Seat::~Seat()
{
	begin_to_end();
	keeper_.join();
	if (closer_.joinable())
		closer_.join();
}

void Seat::begin_to_end()
{
	{
		const std::lock_guard<std::mutex> lock(mutex_);
		stop_ = true;
	}
	wake_.notify_one();
}

void Seat::give_back(void *buffer)
{
	const std::lock_guard<std::mutex> lock(mutex_);
	if (camera_ && camera_of(buffer) == opened_)
		camera_->give_back(buffer);
	else
		free_buffer(buffer);
}

void Seat::suspect()
{
	{
		const std::lock_guard<std::mutex> lock(mutex_);
		if (suspected_ || quiet_)
			return;
		suspected_ = true;
	}
	wake_.notify_one();
}

void Seat::doubt_clock()
{
	const std::lock_guard<std::mutex> lock(mutex_);
	if (camera_)
		camera_->doubt_clock();
}

CameraState Seat::state() const
{
	const std::lock_guard<std::mutex> lock(mutex_);
	if (!camera_)
		return CameraState::ABSENT;
	if (quiet_)
		return CameraState::QUIET;
	return camera_->frozen() ? CameraState::FROZEN : CameraState::STREAMING;
}

std::optional<int64_t> Seat::last_sign_ns() const
{
	const std::lock_guard<std::mutex> lock(mutex_);
	return camera_ ? std::optional<int64_t>(camera_->last_sign_ns()) : std::nullopt;
}

void Seat::check() const
{
	const std::lock_guard<std::mutex> lock(mutex_);
	if (refusal_)
		std::rethrow_exception(refusal_);
}

// False where it is time to end.
bool Seat::sleep(std::chrono::milliseconds time)
{
	std::unique_lock<std::mutex> lock(mutex_);
	return !wake_.wait_for(lock, time, [this] { return stop_; });
}

// Not the same sentence twice.
void Seat::tell(const std::string &sentence)
{
	if (sentence == told_)
		return;
	told_ = sentence;
	pong::say(sentence);
}

void Seat::keep()
{
	while (wait_for_camera()) {
		if (!open())
			continue;
		watch();
		close();
	}
}

// Where its address is known, Aravis is called only when the camera is there and free. One that rig.toml names
// otherwise may come back with another address, which Aravis finds. False: time to end.
bool Seat::wait_for_camera()
{
	const bool is_at_address = parse_address(settings_camera_.id).has_value();
	for (int tries = 0; address_ && sleep(0ms) && (is_at_address || tries < TRIES_AT_OLD_ADDRESS); tries++) {
		const Presence presence = ask_presence(*address_, ANSWER_PATIENCE);
		if (presence == Presence::FREE)
			break;
		if (presence == Presence::CONTROLLED)
			tell(name_ +
			     ": another program controls it, or did when it was killed: waiting until the camera "
			     "is free");
		else if (opened_ == 0)
			tell(name_ +
			     ": not found: nothing answers at this address; waiting for it (pongeye-track --list "
			     "shows the cameras that answer)");
		if (!sleep(SEARCH_INTERVAL))
			return false;
	}
	return sleep(0ms);
}

bool Seat::open()
{
	try {
		auto camera =
			std::make_unique<Camera>(side_, settings_camera_, settings_, opened_ + 1, counts_, receive_);
		address_ = camera->address();
		exposure_ns_ = camera->exposure_ns();
		tell(name_ + (opened_ ? ": it is back" : ": ready") +
		     pong::format(", exposes for %g ms", static_cast<double>(exposure_ns_) * 1e-6));
		const std::lock_guard<std::mutex> lock(mutex_);
		camera_ = std::move(camera);
		opened_++;
		suspected_ = quiet_ = false;
		return true;
	} catch (const Absent &absent) {
		tell(std::string(absent.what()) + "; waiting for it");
	} catch (const pong::Failure &failure) {
		if (opened_ == 0) {
			const std::lock_guard<std::mutex> lock(mutex_);
			refusal_ = std::current_exception();
		} else {
			tell(std::string(failure.what()) + "; trying again");
		}
	}
	sleep(RETRY_INTERVAL);
	return false;
}

// Until the camera is lost, or it is time to end.
void Seat::watch()
{
	for (;;) {
		bool suspected;
		{
			std::unique_lock<std::mutex> lock(mutex_);
			if (wake_.wait_for(lock, WATCH_INTERVAL, [this] { return stop_ || suspected_; }) && stop_)
				return;
			suspected = suspected_;
		}
		const Verdict verdict = examine(*camera_, suspected);
		if (verdict == Verdict::LOST) {
			tell(name_ + ": lost: " + loss_ + "; waiting for it");
			losses_++;
			return;
		}
		if (verdict == Verdict::QUIET)
			tell(name_ +
			     ": it answers, but sends no picture while the trigger runs: is its trigger cable loose?");
		else if (camera_->frozen())
			tell(name_ + ": frozen: it sends the same picture again and again; none of them is used");
		else if (!told_.empty() && monotonic_ns() - camera_->last_sign_ns() < RECENT_NS)
			told_.clear();
		const std::lock_guard<std::mutex> lock(mutex_);
		quiet_ = verdict == Verdict::QUIET || (quiet_ && monotonic_ns() - camera_->last_sign_ns() > RECENT_NS);
		suspected_ = false;
	}
}

Seat::Verdict Seat::examine(Camera &camera, bool suspected)
{
	loss_ = "it no longer answers, or another program took it";
	if (camera.lost())
		return Verdict::LOST;
	const int64_t still_ns = monotonic_ns() - camera.last_sign_ns();
	if (still_ns < RECENT_NS || (!suspected && still_ns < IDLE_NS))
		return Verdict::WELL;
	const std::optional<uint32_t> address = camera.address();
	const Verdict still_there = suspected ? Verdict::QUIET : Verdict::WELL;
	if (!address)
		return still_there;
	const Presence presence = ask_presence(*address, suspected ? SUSPECTED_PATIENCE : IDLE_PATIENCE);
	loss_ = presence == Presence::FREE ? "it was off in between, and knows nothing of us" : "it no longer answers";
	return presence == Presence::CONTROLLED ? still_there : Verdict::LOST;
}

// In another thread, for Aravis waits for a lost camera, 3 s and longer, and it may be back before.
void Seat::close()
{
	std::unique_ptr<Camera> camera;
	{
		const std::lock_guard<std::mutex> lock(mutex_);
		camera = std::move(camera_);
		if (!stop_)
			camera->give_up();
	}
	if (closer_.joinable())
		closer_.join();
	closer_ = std::thread([gone = std::move(camera)]() mutable { gone.reset(); });
}

} // namespace track
