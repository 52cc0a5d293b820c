#include "gpio_chip.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <set>
#include <unistd.h>

#include "gpio_lines.hpp"
#include "program.hpp"

namespace pong
{

namespace
{

bool is_number(const std::string &text)
{
	return !text.empty() && text.size() < 6 &&
	       std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

} // namespace

GpioSpec parse_gpio(const std::string &text)
{
	const size_t colon = text.rfind(':');
	GpioSpec spec;
	if (colon != std::string::npos) {
		spec.chip = text.substr(0, colon);
		for (size_t begin = colon + 1, end; begin <= text.size(); begin = end + 1) {
			end = std::min(text.find(',', begin), text.size());
			spec.lines.push_back(text.substr(begin, end - begin));
		}
	}
	const bool named = std::none_of(spec.lines.begin(), spec.lines.end(),
					[](const std::string &line) { return line.empty(); });
	if (spec.chip.empty() || !named || spec.lines.size() > 2 ||
	    (spec.lines.size() == 2 && spec.lines[0] == spec.lines[1]))
		throw UsageError("--gpio needs CHIP:LINE or CHIP:LINE,LINE, not '" + text + "'");
	return spec;
}

std::string find_chip(const std::string &chip)
{
	if (chip.find('/') != std::string::npos)
		return chip;
	std::string file = "/dev/" + std::string(is_number(chip) ? "gpiochip" : "") + chip;
	if (access(file.c_str(), F_OK) == 0)
		return file;
	std::set<std::string> chips;
	for (const auto &entry : std::filesystem::directory_iterator("/dev"))
		if (entry.path().filename().string().rfind("gpiochip", 0) == 0)
			chips.insert(entry.path().string());
	bool forbidden = false;
	for (const std::string &path : chips) {
		if (chip_label(path) == chip)
			return path;
		forbidden = forbidden || access(path.c_str(), R_OK | W_OK) != 0;
	}
	throw Failure("no GPIO chip is called '" + chip + "'" + (forbidden ? ", among those that may be opened" : ""));
}

void fail_to_open(const std::string &path)
{
	if (errno == EACCES || errno == EPERM)
		throw Failure("no permission for " + path + ": join its group, or see docs/synchronization.md");
	throw Failure(path + ": " + strerror(errno));
}

void fail_to_find(const std::string &path, const std::string &line)
{
	throw Failure(path + " has no line '" + line + "'");
}

void fail_to_take(const std::string &path, const std::string &lines)
{
	if (errno == EBUSY)
		throw Failure(path + ": line " + lines + " is in use by another program");
	throw Failure(path + ": cannot take line " + lines + ": " + strerror(errno));
}

int line_number(const std::string &line)
{
	return is_number(line) ? std::stoi(line) : -1;
}

} // namespace pong
