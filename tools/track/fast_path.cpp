#include "fast_path.hpp"

#include <utility>

#include "clock.hpp"

namespace track
{

FastPath::FastPath(EagerEye &eye, Publisher *publisher) : eye_(eye), publisher_(publisher)
{
}

bool FastPath::claim(pong_side side, int64_t utime, const pong_image &image, bool may_begin)
{
	return eye_.claim(side, utime, image, may_begin);
}

bool FastPath::look(pong_side side, const pong_image &image)
{
	const bool complete = eye_.look(side, image);
	if (complete)
		hurry();
	return complete;
}

bool FastPath::holds(pong_side side, const pong_image &image)
{
	return eye_.holds(side, image);
}

void FastPath::begin(Source &source)
{
	turn_.lock();
	source_ = &source;
}

void FastPath::end()
{
	source_ = nullptr;
	turn_.unlock();
}

// With the turn. The ball is published before its flight is predicted, and the pictures are copied last.
void FastPath::see()
{
	seen_.next = source_->next(seen_.pair);
	if (seen_.next == Next::ALONE)
		eye_.look_alone(seen_.pair);
	if (seen_.next != Next::PAIR)
		return;
	eye_.look(seen_.pair, seen_.sight);
	if (publisher_)
		publisher_->publish_ball(seen_.sight);
	seen_.published_ns = monotonic_ns();
	eye_.predict(seen_.sight);
	if (publisher_)
		publisher_->publish_prediction(seen_.sight);
	eye_.end_pair();
}

// In a camera's thread, which no exception may leave.
void FastPath::hurry()
{
	const std::unique_lock<std::mutex> lock(turn_, std::try_to_lock);
	if (!lock || !source_ || is_new_ || failure_)
		return;
	try {
		see();
		is_new_ = seen_.next != Next::NOTHING_YET;
	} catch (...) {
		failure_ = std::current_exception();
	}
}

const Seen &FastPath::next()
{
	if (failure_)
		std::rethrow_exception(std::exchange(failure_, nullptr));
	if (!is_new_)
		see();
	is_new_ = false;
	return seen_;
}

void FastPath::wait()
{
	Source &source = *source_;
	turn_.unlock();
	source.wait();
	turn_.lock();
}

} // namespace track
