// How somebody at this machine asks for the last seconds to be kept: SIGUSR1, or Enter at the terminal.
#pragma once

namespace track
{

// From now on SIGUSR1 asks, and no longer ends the program.
void listen_for_save_requests();

// Whether somebody has asked since the last time.
bool save_requested();

} // namespace track
