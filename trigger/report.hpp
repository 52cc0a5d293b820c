// One row a second on stdout: what came in that second.
#pragma once

#include <vector>

#include "lateness.hpp"
#include "port.hpp"
#include "table.hpp"

namespace pong
{

class Report
{
public:
	void add(const Pulse &pulse);
	// Writes the row where a second has passed since the last.
	void tick();

private:
	void write(int64_t now);

	TableWriter table_{"-", "utime pulses rate residual_us lateness_us late"};
	int64_t next_ = 0; // monotonic ns; 0 before the first tick
	int64_t pulses_ = 0, late_ = 0;
	std::vector<Pulse> second_;
};

} // namespace pong
