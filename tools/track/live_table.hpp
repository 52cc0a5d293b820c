// The live table on stderr: what the tracker sees, a few rows a second. On a terminal the last row is redrawn in place,
// and every flight leaves one row behind.
#pragma once

#include <cstdint>

#include "pongeye.h"
#include "status.hpp"

namespace track
{

class Live
{
public:
	Live();
	~Live();
	Live(const Live &) = delete;
	Live &operator=(const Live &) = delete;

	// What one more pair showed.
	void see(const pong_sight &sight);

	// Draw a row where the last one is old enough.
	void draw(const StatusReport &report, int64_t now_ns);

private:
	void begin_table();
	void draw_row(const StatusReport &report) const;

	bool terminal_;
	bool tracking_ = false, was_tracking_ = false;
	bool begun_ = false, row_open_ = false;
	int64_t drawn_ns_;
	pong_ball ball_ = {}; // the last one
	bool has_hit_ = false;
	pong_state hit_ = {};
};

} // namespace track
