#include "capture_settings.hpp"

#include <toml++/toml.h>

#include "program.hpp"

namespace track
{

namespace
{

std::string place(const std::string &path, const toml::source_region &source)
{
	return pong::format("%s:%u:%u", path.c_str(), source.begin.line, source.begin.column);
}

// The value of one key, checked; says which file, line and column is at fault.
class Entry
{
public:
	Entry(const std::string &path, const toml::key &key, const toml::node &node)
		: where_(place(path, node.source())), name_("capture." + std::string(key.str())), node_(node)
	{
	}

	double number(double min, double max, const char *unit) const
	{
		const std::optional<double> value = node_.is_number() ? node_.value<double>() : std::nullopt;
		if (!value || !(*value >= min && *value <= max))
			fail(pong::format("must be a number between %g and %g %s", min, max, unit));
		return *value;
	}

	int integer(int min, int max, const char *unit) const
	{
		const std::optional<int64_t> value = node_.is_integer() ? node_.value<int64_t>() : std::nullopt;
		if (!value || *value < min || *value > max)
			fail(pong::format("must be a whole number between %d and %d %s", min, max, unit));
		return static_cast<int>(*value);
	}

	bool yes_or_no() const
	{
		const std::optional<bool> value = node_.value_exact<bool>();
		if (!value)
			fail("must be true or false");
		return *value;
	}

	std::string text() const
	{
		const std::optional<std::string> value = node_.value<std::string>();
		if (!value || value->empty())
			fail("must be a text, such as \"Line1\" or \"none\"");
		return *value;
	}

	// Whether it is the second of two words.
	bool second_of(const char *first, const char *second) const
	{
		const std::optional<std::string> value = node_.value<std::string>();
		if (!value || (*value != first && *value != second))
			fail(pong::format("must be \"%s\" or \"%s\"", first, second));
		return *value == second;
	}

	// A place on a sensor.
	void place_on_sensor(int &x, int &y) const
	{
		const toml::array *pair = node_.as_array();
		if (!pair || pair->size() != 2)
			fail("must be two whole numbers, [x, y]");
		int *const target[] = {&x, &y};
		for (size_t i = 0; i < 2; i++) {
			const std::optional<int64_t> value =
				(*pair)[i].is_integer() ? (*pair)[i].value<int64_t>() : std::nullopt;
			if (!value || *value < 0 || *value > 65535)
				fail("must be two whole numbers, [x, y], between 0 and 65535 px");
			*target[i] = static_cast<int>(*value);
		}
	}

private:
	[[noreturn]] void fail(const std::string &what) const
	{
		throw pong::Failure(where_ + ": " + name_ + " " + what);
	}

	std::string where_, name_;
	const toml::node &node_;
};

void set(CaptureSettings &settings, const std::string &path, const toml::key &key, const toml::node &node)
{
	const Entry entry(path, key, node);
	if (key == "exposure") {
		settings.exposure = entry.number(1e-6, 1, "s");
	} else if (key == "gain") {
		settings.gain = entry.number(-100, 100, "dB");
		settings.has_gain = true;
	} else if (key == "trigger") {
		const std::string trigger = entry.text();
		settings.trigger = trigger == "none" ? "" : trigger;
	} else if (key == "rate") {
		settings.rate = entry.number(0.1, 10000, "Hz");
	} else if (key == "edge") {
		settings.falling_edge = entry.second_of("rising", "falling");
	} else if (key == "offset") {
		entry.place_on_sensor(settings.offset_x, settings.offset_y);
	} else if (key == "counter") {
		settings.counter = entry.yes_or_no();
	} else if (key == "ptp") {
		settings.ptp = entry.yes_or_no();
	} else if (key == "packet_size") {
		settings.packet_size = entry.integer(576, 16000, "bytes");
	} else if (key == "packet_delay") {
		settings.packet_delay = entry.number(0, 0.01, "s");
	} else {
		throw pong::Failure(place(path, key.source()) + ": unknown key '" + std::string(key.str()) +
				    "' in [capture]: there are exposure, gain, trigger, edge, rate, offset, "
				    "counter, ptp, packet_size, packet_delay");
	}
}

toml::table parse(const std::string &path)
{
	try {
		return toml::parse_file(path);
	} catch (const toml::parse_error &error) {
		throw pong::Failure(place(path, error.source()) + ": " + std::string(error.description()));
	}
}

} // namespace

CaptureSettings load_capture_settings(const std::string &path)
{
	CaptureSettings settings;
	const toml::table file = parse(path);
	const toml::node *section = file.get("capture");
	if (!section)
		return settings;
	if (!section->is_table())
		throw pong::Failure(place(path, section->source()) + ": capture must be a section, [capture]");
	for (const auto &[key, node] : *section->as_table())
		set(settings, path, key, node);
	return settings;
}

} // namespace track
