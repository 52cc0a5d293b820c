// GPIO lines by libgpiod 1.
#include "gpio_lines.hpp"

#include <gpiod.h>

#include "gpio_chip.hpp"
#include "program.hpp"

namespace pong
{

struct GpioLines::Handles {
	gpiod_chip *chip = nullptr;
	gpiod_line_bulk lines = {};

	// The lines go with their chip.
	~Handles()
	{
		if (chip)
			gpiod_chip_close(chip);
	}
};

std::string chip_label(const std::string &path)
{
	gpiod_chip *chip = gpiod_chip_open(path.c_str());
	if (!chip)
		return "";
	std::string label = gpiod_chip_label(chip);
	gpiod_chip_close(chip);
	return label;
}

GpioLines::GpioLines(const GpioSpec &spec, bool active_low) : handles_(std::make_unique<Handles>())
{
	const std::string path = find_chip(spec.chip);
	handles_->chip = gpiod_chip_open(path.c_str());
	if (!handles_->chip)
		fail_to_open(path);
	gpiod_line_bulk_init(&handles_->lines);
	std::string names;
	for (const std::string &name : spec.lines) {
		const int number = line_number(name);
		gpiod_line *line = number < 0 ? gpiod_chip_find_line(handles_->chip, name.c_str())
					      : gpiod_chip_get_line(handles_->chip, static_cast<unsigned>(number));
		if (!line)
			fail_to_find(path, name);
		gpiod_line_bulk_add(&handles_->lines, line);
		names += names.empty() ? name : "," + name;
	}
	const gpiod_line_request_config wanted = {"pongeye-trigger", GPIOD_LINE_REQUEST_DIRECTION_OUTPUT,
						  active_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0};
	const int inactive[] = {0, 0};
	if (gpiod_line_request_bulk(&handles_->lines, &wanted, inactive))
		fail_to_take(path, names);
}

GpioLines::~GpioLines()
{
	set(false);
}

bool GpioLines::set(bool active)
{
	const int values[] = {active, active};
	return gpiod_line_set_value_bulk(&handles_->lines, values) == 0;
}

} // namespace pong
