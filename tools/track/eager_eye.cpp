#include "eager_eye.hpp"

#include <cmath>
#include <cstdlib>

#include "pairing.hpp"
#include "program.hpp"

namespace track
{

namespace
{

const pong_image &image_of(const StereoPair &pair, pong_side side)
{
	return side == PONG_LEFT ? pair.left : pair.right;
}

} // namespace

EagerEye::EagerEye(pong_eye *eye, double rate) : eye_(eye), tolerance_(rate > 0 ? PAIRING_TOLERANCE * 1e6 / rate : 0)
{
}

bool EagerEye::claim(pong_side side, int64_t utime, const pong_image &image, bool may_begin)
{
	const std::lock_guard<std::mutex> lock(mutex_);
	const Part &other = parts_[1 - side];
	if (taken_ || !in_step_ || parts_[side].pixels)
		return false;
	if (!begun_ ? !may_begin || !begin(side, utime)
		    : static_cast<double>(std::abs(utime - other.utime)) >= tolerance_)
		return false;
	parts_[side] = {image.pixels, utime};
	looking_++;
	return true;
}

// With the lock held: the eye works out where the ball must be.
bool EagerEye::begin(pong_side side, int64_t utime)
{
	utime_ = utime + std::llround((side == PONG_LEFT ? difference_ : -difference_) / 2);
	begun_ = tolerance_ > 0 && pong_eye_expect(eye_, utime_) == PONG_FOUND;
	return begun_;
}

void EagerEye::look_at(pong_side side, const pong_image &image)
{
	pong_error error = {};
	if (pong_eye_look(eye_, side, &image, &error) >= 0)
		return;
	const std::lock_guard<std::mutex> lock(mutex_);
	if (!*error_.text) // the first one says enough
		error_ = error;
}

bool EagerEye::look(pong_side side, const pong_image &image)
{
	look_at(side, image);
	const std::lock_guard<std::mutex> lock(mutex_);
	looking_--;
	if (waiting_)
		changed_.notify_one();
	return looking_ == 0 && parts_[1 - side].pixels;
}

bool EagerEye::holds(pong_side side, const pong_image &image)
{
	const std::lock_guard<std::mutex> lock(mutex_);
	return parts_[side].pixels == image.pixels;
}

// False where the pair is not later than the one before.
bool EagerEye::begin_unless_begun(StereoPair &pair)
{
	std::unique_lock<std::mutex> lock(mutex_);
	waiting_ = true;
	changed_.wait(lock, [this] { return looking_ == 0; });
	waiting_ = false;
	bool claimed = false;
	for (const pong_side side : {PONG_LEFT, PONG_RIGHT}) {
		if (parts_[side].pixels != image_of(pair, side).pixels)
			parts_[side] = {};
		claimed |= parts_[side].pixels != nullptr;
	}
	taken_ = true;
	if (!claimed)
		return pong_eye_expect(eye_, pair.utime) == PONG_FOUND;
	pair.utime = utime_;
	return true;
}

void EagerEye::learn_difference()
{
	constexpr double GAIN = 0.1;
	const Part &left = parts_[PONG_LEFT], &right = parts_[PONG_RIGHT];
	if (left.pixels && right.pixels)
		difference_ += GAIN * (static_cast<double>(right.utime - left.utime) - difference_);
}

// From the next pair on: where this one's ball must be was worked out before its pictures came.
void EagerEye::take_exposures(const StereoPair &pair)
{
	for (const pong_side side : {PONG_LEFT, PONG_RIGHT})
		if (pair.exposure_us[side] > 0)
			pong_eye_set_exposure(eye_, side, pair.exposure_us[side] * 1e-6);
}

void EagerEye::end(bool complete)
{
	pong_eye_keep(eye_);
	const std::lock_guard<std::mutex> lock(mutex_);
	learn_difference();
	parts_[PONG_LEFT] = parts_[PONG_RIGHT] = {};
	begun_ = taken_ = false;
	in_step_ = complete;
}

void EagerEye::look(StereoPair &pair, pong_sight &sight)
{
	sight = {};
	if (!begin_unless_begun(pair)) {
		sight.outcome = PONG_OUT_OF_ORDER;
		return;
	}
	for (const pong_side side : {PONG_LEFT, PONG_RIGHT})
		if (!parts_[side].pixels)
			look_at(side, image_of(pair, side));
	if (*error_.text)
		throw pong::Failure(pong::format("pair %lld: %s", static_cast<long long>(pair.frame), error_.text));
	pong_eye_join(eye_, pair.frame, &sight);
	take_exposures(pair);
}

void EagerEye::predict(pong_sight &sight)
{
	pong_eye_predict(eye_, &sight);
}

void EagerEye::end_pair()
{
	end(true);
}

void EagerEye::look_alone(StereoPair &alone)
{
	if (begin_unless_begun(alone))
		for (const pong_side side : {PONG_LEFT, PONG_RIGHT})
			if (!parts_[side].pixels && image_of(alone, side).pixels)
				look_at(side, image_of(alone, side));
	take_exposures(alone);
	end(false);
}

} // namespace track
