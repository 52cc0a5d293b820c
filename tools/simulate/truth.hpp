// What the cameras should have seen: one row a frame, for whoever scores a tracker.
#pragma once

#include "table.hpp"
#include "world.hpp"

namespace sim
{

class Truth
{
public:
	Truth(const std::string &path, const Rig &rig);

	// `time` is the middle of the exposure on the world's clock, s; `utime` the same in microseconds.
	void add(int64_t utime, int64_t frame, const Episode *episode, double time);

private:
	void add_ball(int64_t utime, const Episode &episode, double time);

	pong::TableWriter table_;
	const Rig rig_;
};

// The truth of boards: where each stood, one row a frame that shows one.
class BoardTruth
{
public:
	explicit BoardTruth(const std::string &path);

	void add(int64_t utime, int64_t frame, const Episode &episode);

private:
	pong::TableWriter table_;
};

} // namespace sim
