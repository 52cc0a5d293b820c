// Looks at both pictures of a pair at once: at the left one in a thread of its own, at the right one in the caller's.
#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

#include "pongeye.h"
#include "source.hpp"

namespace track
{

class TwoEyes
{
public:
	// The eye is borrowed. priority: of the thread, real-time where the user may have it; 0: an ordinary one.
	TwoEyes(pong_eye *eye, int priority);
	~TwoEyes();
	TwoEyes(const TwoEyes &) = delete;
	TwoEyes &operator=(const TwoEyes &) = delete;

	// What pong_eye_push does, to the bit. Throws pong::Failure where a picture has not its camera's size.
	void look(const StereoPair &pair, pong_sight &sight);

private:
	void look_left(int priority);
	const pong_image *wait_for_picture();

	pong_eye *eye_;
	std::mutex mutex_; // guards what follows
	std::condition_variable changed_;
	const pong_image *left_ = nullptr; // to be looked at
	bool looked_ = false, stop_ = false;
	int result_ = 0;
	pong_error error_ = {};
	std::thread thread_;
};

} // namespace track
