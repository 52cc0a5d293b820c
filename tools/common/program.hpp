// What every program does alike: name itself in errors, exit 0 done, 1 failed, 2 usage, and end cleanly on Ctrl-C.
#pragma once

#include <stdexcept>
#include <string>

namespace pong
{

// The world's fault: one sentence, exit 1.
struct Failure : std::runtime_error {
	using std::runtime_error::runtime_error;
};

// The user's fault on the command line: one sentence, exit 2.
struct UsageError : std::runtime_error {
	using std::runtime_error::runtime_error;
};

// Printf into a string.
std::string format(const char *text, ...) __attribute__((format(printf, 1, 2)));

// Run `body` as a program: signals end it by stop_requested(), exceptions become one sentence on stderr.
int run_program(const char *name, int argc, char **argv, int (*body)(int argc, char **argv));

// One sentence on stderr, with the program's name in front.
void say(const std::string &sentence);

// True from the first SIGINT or SIGTERM on.
bool stop_requested();

// Ask the program to end, as Ctrl-C would.
void request_stop();

} // namespace pong
