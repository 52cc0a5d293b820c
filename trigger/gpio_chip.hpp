// What both versions of libgpiod share.
#pragma once

#include <string>

namespace pong
{

// The label of the chip at a file, by the installed libgpiod; empty where it cannot be opened.
std::string chip_label(const std::string &path);

// The file `path` cannot be opened, for errno's reason.
[[noreturn]] void fail_to_open(const std::string &path);

// The chip has no such line.
[[noreturn]] void fail_to_find(const std::string &path, const std::string &line);

// The lines, as the user named them, cannot be taken, for errno's reason.
[[noreturn]] void fail_to_take(const std::string &path, const std::string &lines);

// A line's number where its name is one, or -1.
int line_number(const std::string &line);

} // namespace pong
