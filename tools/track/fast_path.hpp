// From a pair's second picture to its messages by the shortest way: the thread of the camera that brought the picture
// sees the pair and publishes, rather than waking another one to do it. Whatever can wait is the tracking thread's.
//
// One thread at a time has the turn, and with it the source, the eye and the publisher. The tracking thread has it
// whenever it does not wait. No camera's thread ever waits for it: where it is taken, the tracking thread is woken, and
// does it all.
#pragma once

#include <exception>
#include <mutex>

#include "eager_eye.hpp"
#include "onlooker.hpp"
#include "publisher.hpp"
#include "source.hpp"

namespace track
{

// What came of a pair.
struct Seen {
	Next next; // a sight has only a PAIR
	StereoPair pair;
	pong_sight sight;
	int64_t published_ns; // when its ball was, by monotonic_ns()
};

class FastPath : public Onlooker
{
public:
	// All is borrowed; publisher: null where nothing is published.
	FastPath(EagerEye &eye, Publisher *publisher);

	// For the cameras' threads.
	bool claim(pong_side side, int64_t utime, const pong_image &image, bool may_begin) override;
	bool look(pong_side side, const pong_image &image) override;
	bool holds(pong_side side, const pong_image &image) override;

	// For the tracking thread: it takes the turn, and the cameras' threads may, until it ends.
	void begin(Source &source);
	void end();

	// What was seen next: by a camera's thread, or now. It stays until the next call of next() or wait().
	const Seen &next();

	// Leave the turn to others, until there is something to do, but not for long.
	void wait();

private:
	void see();
	void hurry();

	EagerEye &eye_;
	Publisher *const publisher_;
	std::mutex turn_; // guards what follows
	Source *source_ = nullptr;
	Seen seen_ = {};
	bool is_new_ = false;        // the tracking thread does not know of seen_ yet
	std::exception_ptr failure_; // of a camera's thread
};

} // namespace track
