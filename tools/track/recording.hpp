// The recording of a session: the recorder, what it overhears, and whoever asks it to save.
#pragma once

#include <memory>

#include "arguments.hpp"
#include "overheard.hpp"
#include "publisher.hpp"
#include "recorder.hpp"
#include "setup.hpp"

namespace track
{

class Recording
{
public:
	// What the publisher publishes is recorded too. Throws pong::Failure.
	Recording(const Arguments &arguments, const Setup &setup, Publisher &publisher);

	void add(const StereoPair &pair, const pong_sight &sight)
	{
		recorder_.add_pair(pair, sight);
	}

	// A picture without a partner that was looked at.
	void add_alone(const StereoPair &alone)
	{
		recorder_.add_alone(alone);
	}

	// What others said meanwhile.
	void listen();

	// End, and say what there is to say. False where not everything could be written.
	bool finish();

private:
	const bool saves_on_request_;
	Recorder recorder_;
	std::unique_ptr<Overheard> overheard_; // null where nobody can be heard
};

} // namespace track
