// Stereo pairs from a recording: what the cameras gave, or, where only windows were recorded, pictures that have the
// last whole ones around them.
#pragma once

#include <cstdio>
#include <memory>
#include <string>

#include "event_log.hpp"
#include "pair_message.hpp"
#include "pongeye/recording_t.hpp"
#include "setup.hpp"
#include "source.hpp"

namespace track
{

class Replay : public Source
{
public:
	// "-" is standard input. Throws pong::Failure where it is not a recording.
	explicit Replay(const std::string &path);

	// From an open file, which is closed in the end; `name` stands for it in errors.
	Replay(FILE *file, const std::string &name);

	// What it was made with. Throws pong::Failure where the recording does not say.
	RigText rig() const;
	pong_profile profile() const;

	// Throws pong::Failure where the whole recording has no pictures.
	Next next(StereoPair &pair) override;

	Dropped dropped() const override
	{
		return {};
	}

private:
	struct Close {
		void operator()(FILE *file) const
		{
			fclose(file);
		}
	};

	void read_header();
	bool take_header();
	bool decode_pictures(bool alone);
	bool take_alone(StereoPair &alone);
	bool take_pair(StereoPair &pair);
	int64_t missing() const;
	void end(EventReader::Result how);

	std::string name_;
	std::unique_ptr<FILE, Close> file_;
	EventReader reader_;
	Event event_;
	bool pending_ = false; // event_ was read, and not looked at yet
	bool has_header_ = false;
	pongeye::recording_t header_;
	pongeye::pair_t message_;
	Unpacker unpacker_;
	int64_t first_number_ = 0, last_number_ = 0; // of the pairs that were recorded
	int64_t pairs_ = 0, damaged_ = 0;
};

} // namespace track
