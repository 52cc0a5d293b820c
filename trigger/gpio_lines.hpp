// One or two GPIO lines, driven together, through libgpiod: gpio_lines_v1.cpp or gpio_lines_v2.cpp, whichever the
// installed library is.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace pong
{

// What --gpio names: a chip by name, label, number or file, and lines by name or number.
struct GpioSpec {
	std::string chip;
	std::vector<std::string> lines;
};

// "CHIP:LINE" or "CHIP:LINE,LINE". Throws UsageError.
GpioSpec parse_gpio(const std::string &text);

// The file of a chip. Throws Failure where there is none of that name or label.
std::string find_chip(const std::string &chip);

class GpioLines
{
public:
	// Takes the lines as outputs, inactive. Throws Failure: no such line, in use, no permission.
	GpioLines(const GpioSpec &spec, bool active_low);
	// Inactive, then given back.
	~GpioLines();
	GpioLines(const GpioLines &) = delete;
	GpioLines &operator=(const GpioLines &) = delete;

	// All at once, as far as the kernel's driver can. False where the kernel refuses: errno says why.
	bool set(bool active);

private:
	struct Handles;
	std::unique_ptr<Handles> handles_;
};

} // namespace pong
