#include "program.hpp"

#include <atomic>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <unistd.h>

namespace pong
{

namespace
{

const char *program_name = "pongeye";
// Lock-free, so that a signal handler may set it, and other threads than main may look at it.
std::atomic<bool> stop = false;
static_assert(std::atomic<bool>::is_always_lock_free);

void on_signal(int)
{
	stop = true;
}

// Without SA_RESTART, so that a blocking call returns and the loop sees the request.
void catch_signals()
{
	struct sigaction action = {};
	action.sa_handler = on_signal;
	sigaction(SIGINT, &action, nullptr);
	sigaction(SIGTERM, &action, nullptr);
	signal(SIGPIPE, SIG_IGN);
}

} // namespace

std::string format(const char *text, ...)
{
	char buffer[1024];
	va_list arguments;
	va_start(arguments, text);
	vsnprintf(buffer, sizeof buffer, text, arguments);
	va_end(arguments);
	return buffer;
}

int run_program(const char *name, int argc, char **argv, int (*body)(int argc, char **argv))
{
	program_name = name;
	catch_signals();
	try {
		return body(argc, argv);
	} catch (const UsageError &error) {
		say(std::string(error.what()) + " (see --help)");
		return 2;
	} catch (const std::exception &error) {
		say(error.what());
		return 1;
	}
}

void say(const std::string &sentence)
{
	// On a terminal a row that is redrawn in place may stand in this line.
	fprintf(stderr, "%s%s: %s\n", isatty(STDERR_FILENO) ? "\r\033[K" : "", program_name, sentence.c_str());
}

bool stop_requested()
{
	return stop;
}

void request_stop()
{
	stop = true;
}

} // namespace pong
