#include "save_request.hpp"

#include <atomic>
#include <csignal>
#include <poll.h>
#include <unistd.h>

namespace track
{

namespace
{

// Lock-free, so that a signal handler may set it.
std::atomic<bool> asked = false;
static_assert(std::atomic<bool>::is_always_lock_free);

void on_signal(int)
{
	asked = true;
}

// Only of a terminal that is ours: a job in the background that reads from it is stopped.
bool enter_pressed()
{
	pollfd input = {STDIN_FILENO, POLLIN, 0};
	if (!isatty(STDIN_FILENO) || tcgetpgrp(STDIN_FILENO) != getpgrp() || poll(&input, 1, 0) != 1)
		return false;
	char line[256];
	return read(STDIN_FILENO, line, sizeof line) > 0;
}

} // namespace

void listen_for_save_requests()
{
	struct sigaction action = {};
	action.sa_handler = on_signal;
	action.sa_flags = SA_RESTART; // reading a recording from a pipe goes on
	sigaction(SIGUSR1, &action, nullptr);
}

bool save_requested()
{
	const bool entered = enter_pressed();
	return asked.exchange(false) || entered;
}

} // namespace track
