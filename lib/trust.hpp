// How far a ball that was found is to be believed. Where nothing else moves, what looks like a ball is one.
#pragma once

#include "expect.hpp"
#include "match.hpp"
#include "side.hpp"
#include "track.hpp"

namespace pong
{

Trust trust_of(const Match &match, const Side side[2], const pong_settings &settings);

// Amid what else moves, a doubtful point that begins no flight is only believed where one has the ball.
bool is_hopeless(const Match &match, Trust trust, const FollowedFlight &flight);

// A point that may be anywhere, and of which nothing else says that it is the ball. By the paper's method all count.
bool is_hardly_known(const pong_point &point, Trust trust, const pong_settings &settings);

// The flight has begun with this point, or has got it besides.
void count_point(const Match &match, pong_track_event event, FollowedFlight *flight);

// The point as it is amid what else moves. What is behind the ball is not well known there: its centres are less
// certain than their fits tell, and the less so the less they agree.
pong_point doubted(const Match &match);

} // namespace pong
