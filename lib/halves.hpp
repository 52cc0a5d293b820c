// The paper's state of a flight: its points cut in two halves (section 6, Fig. 8).
#pragma once

#include <vector>

#include "pongeye.h"

namespace pong
{

// The points of one ball.
class Halves
{
public:
	Halves();

	void clear();
	void add(const pong_point &point, const pong_rig &rig);

	// From the leg since the last bounce; from the leg before it where the new one has but one point yet.
	bool state(pong_state *state) const;
	// From its latest few points only.
	bool recent_state(pong_state *state) const;

private:
	bool state_of_latest(size_t most, pong_state *state) const;
	void forget_half();
	bool has_bounced(const pong_point &point, const pong_rig &rig) const;

	std::vector<pong_point> points_;
	size_t since_bounce_ = 0, before_bounce_ = 0; // where the present leg and the one before it begin
};

} // namespace pong
