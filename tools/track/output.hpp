// The table that --output writes: one row a stereo pair.
#pragma once

#include <string>

#include "pongeye.h"
#include "source.hpp"
#include "table.hpp"

namespace track
{

class Output
{
public:
	// path: a file, or "-" for stdout. Throws pong::Failure where it cannot be written.
	explicit Output(const std::string &path);

	void write(const StereoPair &pair, const pong_sight &sight);

private:
	void add_ball(const pong_ball &ball);
	void add_hit(const pong_prediction &prediction);

	pong::TableWriter table_;
};

} // namespace track
