// The table's corners as a view that sets the frame: located in the pictures, added to the problem, checked against the
// table's size.
#pragma once

#include "arguments.hpp"
#include "session.hpp"

namespace calibrate
{

// Fill session.table as the arguments ask: from given pixels, or found or refined in the pair that --table names, which
// is taken out of the pairs where it shows no board. Throws pong::Failure.
void locate_table(const Arguments &arguments, Session &session);

// The table as a board of its own that stands in the table frame. Where its size is only a check, its points may lie
// anywhere.
void add_table(const Arguments &arguments, Session &session);

// Note what its sides measure. Throws pong::Failure where corners that were found in pictures do not fit its size.
void check_table(const Arguments &arguments, Session &session);

} // namespace calibrate
