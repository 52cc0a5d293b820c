// Points of more and less trust.
#pragma once

#include "pongeye.h"

namespace pong
{

// How far a point is to be believed that does not continue the flight.
enum class Trust {
	none,    // it may be a person's hand: begins no flight
	likely,  // a second such point must confirm that it flies
	usual,   // begins a flight at once, but only where no other one is
	certain, // a ball and nothing else: begins a flight soon after another was last seen
};

// As pong_track_push, whose points are of usual trust. What a point tells that is PONG_TRACK_FOLLOWED is only worked
// out by settle(), which takes most of the time: until then the flight's state is that of the point before.
pong_track_event push_point(pong_track &track, const pong_point &point, Trust trust);
void settle(pong_track &track);

// Whether enough of the flight's points were believed by themselves.
bool is_firm(const pong_track &track);

} // namespace pong
