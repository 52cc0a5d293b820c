// GPIO lines by libgpiod 2.
#include "gpio_lines.hpp"

#include <gpiod.h>

#include "gpio_chip.hpp"
#include "program.hpp"

namespace pong
{

namespace
{

// Closes whatever of libgpiod it holds.
template<typename Object, void (*close)(Object *)> struct Closer {
	void operator()(Object *object) const
	{
		close(object);
	}
};
template<typename Object, void (*close)(Object *)> using Holder = std::unique_ptr<Object, Closer<Object, close>>;

using Chip = Holder<gpiod_chip, gpiod_chip_close>;
using ChipInfo = Holder<gpiod_chip_info, gpiod_chip_info_free>;
using LineSettings = Holder<gpiod_line_settings, gpiod_line_settings_free>;
using LineConfig = Holder<gpiod_line_config, gpiod_line_config_free>;
using RequestConfig = Holder<gpiod_request_config, gpiod_request_config_free>;
using Request = Holder<gpiod_line_request, gpiod_line_request_release>;

std::vector<unsigned> find_lines(gpiod_chip *chip, const std::string &path, const std::vector<std::string> &names)
{
	const ChipInfo info(gpiod_chip_get_info(chip));
	const int count = info ? static_cast<int>(gpiod_chip_info_get_num_lines(info.get())) : 0;
	std::vector<unsigned> offsets;
	for (const std::string &name : names) {
		int number = line_number(name);
		if (number < 0)
			number = gpiod_chip_get_line_offset_from_name(chip, name.c_str());
		if (number < 0 || number >= count)
			fail_to_find(path, name);
		offsets.push_back(static_cast<unsigned>(number));
	}
	return offsets;
}

} // namespace

struct GpioLines::Handles {
	Request request;
	size_t lines = 0;
};

std::string chip_label(const std::string &path)
{
	const Chip chip(gpiod_chip_open(path.c_str()));
	const ChipInfo info(chip ? gpiod_chip_get_info(chip.get()) : nullptr);
	return info ? gpiod_chip_info_get_label(info.get()) : "";
}

GpioLines::GpioLines(const GpioSpec &spec, bool active_low) : handles_(std::make_unique<Handles>())
{
	const std::string path = find_chip(spec.chip);
	const Chip chip(gpiod_chip_open(path.c_str()));
	if (!chip)
		fail_to_open(path);
	const std::vector<unsigned> offsets = find_lines(chip.get(), path, spec.lines);

	const LineSettings settings(gpiod_line_settings_new());
	const LineConfig lines(gpiod_line_config_new());
	const RequestConfig request(gpiod_request_config_new());
	if (!settings || !lines || !request)
		throw std::bad_alloc();
	gpiod_line_settings_set_direction(settings.get(), GPIOD_LINE_DIRECTION_OUTPUT);
	gpiod_line_settings_set_active_low(settings.get(), active_low);
	gpiod_line_settings_set_output_value(settings.get(), GPIOD_LINE_VALUE_INACTIVE);
	gpiod_line_config_add_line_settings(lines.get(), offsets.data(), offsets.size(), settings.get());
	gpiod_request_config_set_consumer(request.get(), "pongeye-trigger");

	handles_->lines = offsets.size();
	handles_->request.reset(gpiod_chip_request_lines(chip.get(), request.get(), lines.get()));
	if (!handles_->request)
		fail_to_take(path, spec.lines.size() == 1 ? spec.lines[0] : spec.lines[0] + "," + spec.lines[1]);
}

GpioLines::~GpioLines()
{
	set(false);
}

bool GpioLines::set(bool active)
{
	const gpiod_line_value value = active ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
	const gpiod_line_value values[] = {value, value};
	static_assert(sizeof values / sizeof *values == 2, "parse_gpio() lets no more than two lines through");
	return gpiod_line_request_set_values(handles_->request.get(), values) == 0;
}

} // namespace pong
