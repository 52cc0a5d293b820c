#include "two_eyes.hpp"

#include "program.hpp"
#include "realtime.hpp"

namespace track
{

TwoEyes::TwoEyes(pong_eye *eye, int priority) : eye_(eye), thread_([this, priority] { look_left(priority); })
{
}

TwoEyes::~TwoEyes()
{
	{
		const std::lock_guard<std::mutex> lock(mutex_);
		stop_ = true;
	}
	changed_.notify_all();
	thread_.join();
}

// Null: time to end.
const pong_image *TwoEyes::wait_for_picture()
{
	std::unique_lock<std::mutex> lock(mutex_);
	changed_.wait(lock, [this] { return left_ || stop_; });
	const pong_image *left = left_;
	left_ = nullptr;
	return left;
}

void TwoEyes::look_left(int priority)
{
	if (priority > 0)
		make_thread_realtime(priority);
	while (const pong_image *left = wait_for_picture()) {
		pong_error error = {};
		const int result = pong_eye_look(eye_, PONG_LEFT, left, &error);
		{
			const std::lock_guard<std::mutex> lock(mutex_);
			result_ = result;
			error_ = error;
			looked_ = true;
		}
		changed_.notify_all();
	}
}

void TwoEyes::look(const StereoPair &pair, pong_sight &sight)
{
	sight = {};
	if (!pong_eye_expect(eye_, pair.utime)) {
		sight.outcome = PONG_OUT_OF_ORDER;
		return;
	}
	{
		const std::lock_guard<std::mutex> lock(mutex_);
		left_ = &pair.left;
		looked_ = false;
	}
	changed_.notify_all();
	pong_error error = {};
	const int right = pong_eye_look(eye_, PONG_RIGHT, &pair.right, &error);
	std::unique_lock<std::mutex> lock(mutex_);
	changed_.wait(lock, [this] { return looked_; });
	if (result_ < 0 || right < 0)
		throw pong::Failure(pong::format("pair %lld: %s", static_cast<long long>(pair.frame),
						 result_ < 0 ? error_.text : error.text));
	pong_eye_join(eye_, pair.frame, &sight);
}

} // namespace track
