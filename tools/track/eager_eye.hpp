// Looks at each camera's picture when it comes, in that camera's thread: while the later picture of a pair still comes
// in the earlier one is searched.
//
// Which pictures are a pair is not known then. The first to come begins a pair, provided that the last one was
// complete; the other camera's next picture within a third of a period goes on with it. Where no partner comes the eye
// has seen a picture alone, which whoever repeats the session must show it too: look_alone() tells. The time of a pair
// must be known before its second picture is here: it is that of the first, and half of what the two cameras' times
// differed by of late.
#pragma once

#include <condition_variable>
#include <mutex>

#include "onlooker.hpp"
#include "pongeye.h"
#include "source.hpp"

namespace track
{

class EagerEye : public Onlooker
{
public:
	// The eye is borrowed. rate: pairs a second; 0: not known, and nothing is looked at before it is a pair.
	EagerEye(pong_eye *eye, double rate);

	bool claim(pong_side side, int64_t utime, const pong_image &image, bool may_begin) override;
	bool look(pong_side side, const pong_image &image) override;
	bool holds(pong_side side, const pong_image &image) override;

	// The rest is for one thread at a time. Look at what nobody has looked at yet, and find the pair's ball. The
	// pair is given the time that the eye was told. Throws pong::Failure where a picture has not its camera's size.
	void look(StereoPair &pair, pong_sight &sight);

	// Then predict the ball's flight, and see the pair to its end. What comes of it all is what pong_eye_push makes
	// of pair and time, to the bit.
	void predict(pong_sight &sight);
	void end_pair();

	// There is no partner for this picture, which was claimed or comes from a recording. It is given the time that
	// the eye was told.
	void look_alone(StereoPair &alone);

private:
	// One camera's part in the pair that is begun.
	struct Part {
		const uint8_t *pixels = nullptr; // of the picture that was claimed
		int64_t utime = 0;
	};

	bool begin(pong_side side, int64_t utime);
	bool begin_unless_begun(StereoPair &pair);
	void end(bool complete);
	void look_at(pong_side side, const pong_image &image);
	void learn_difference();
	void take_exposures(const StereoPair &pair);

	pong_eye *const eye_;
	const double tolerance_; // us

	std::mutex mutex_; // guards what follows
	std::condition_variable changed_;
	Part parts_[2];         // by pong_side
	bool begun_ = false;    // the eye expects a pair
	bool taken_ = false;    // somebody sees the pair to its end
	bool in_step_ = false;  // the last pair was complete
	int looking_ = 0;       // cameras' threads,
	bool waiting_ = false;  // and somebody waits for them
	int64_t utime_ = 0;     // of the pair that is begun
	double difference_ = 0; // right less left time of a pair, of late, us
	pong_error error_ = {}; // of a look, where its text is not empty
};

} // namespace track
