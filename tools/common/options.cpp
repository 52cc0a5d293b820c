#include "options.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "pongeye.h"
#include "program.hpp"

namespace pong
{

namespace
{

double to_number(const std::string &name, const std::string &text, double min, double max)
{
	char *end;
	const double value = strtod(text.c_str(), &end);
	if (text.empty() || *end || !std::isfinite(value))
		throw UsageError(name + " needs a number, not '" + text + "'");
	if (value < min || value > max)
		throw UsageError(format("%s must lie between %g and %g, not %g", name.c_str(), min, max, value));
	return value;
}

std::string join(const std::vector<std::string> &words, const char *between)
{
	std::string joined;
	for (const std::string &word : words)
		joined += (joined.empty() ? "" : between) + word;
	return joined;
}

} // namespace

Options::Options(std::string program, std::string summary, std::string example)
	: program_(std::move(program)), summary_(std::move(summary)), example_(std::move(example))
{
}

void Options::add(const char *name, const std::string &value, const char *help,
		  std::function<void(const std::string &)> set)
{
	options_.push_back({name, value, help, std::move(set), false, false});
}

void Options::text(const char *name, const char *value, const char *help, std::string *target)
{
	add(name, value, help, [target](const std::string &text) { *target = text; });
}

void Options::optional_text(const char *name, const char *value, const char *help, std::string *target)
{
	text(name, value, help, target);
	options_.back().value_optional = true;
}

void Options::number(const char *name, const char *value, const char *help, double *target, double min, double max)
{
	add(name, value, help, [=](const std::string &text) { *target = to_number(name, text, min, max); });
}

void Options::integer(const char *name, const char *value, const char *help, int *target, int min, int max)
{
	add(name, value, help, [=](const std::string &text) {
		const double number = to_number(name, text, min, max);
		if (number != std::floor(number))
			throw UsageError(std::string(name) + " needs a whole number, not '" + text + "'");
		*target = static_cast<int>(number);
	});
}

void Options::flag(const char *name, const char *help, bool *target)
{
	add(name, "", help, [target](const std::string &) { *target = true; });
}

void Options::choice(const char *name, std::vector<std::string> words, const char *help, int *target)
{
	const std::string value = join(words, "|");
	add(name, value, help, [=](const std::string &text) {
		const auto word = std::find(words.begin(), words.end(), text);
		if (word == words.end())
			throw UsageError(std::string(name) + " is one of " + join(words, ", ") + ", not '" + text +
					 "'");
		*target = static_cast<int>(word - words.begin());
	});
}

Options::Option *Options::find(const std::string &name)
{
	for (Option &option : options_)
		if (option.name == name)
			return &option;
	return nullptr;
}

bool Options::given(const char *name) const
{
	for (const Option &option : options_)
		if (option.name == name)
			return option.given;
	return false;
}

// Both --name VALUE and --name=VALUE.
bool Options::parse(int argc, char **argv)
{
	for (int i = 1; i < argc; i++) {
		std::string name = argv[i], value;
		const size_t equals = name.find('=');
		const bool joined = name.rfind("--", 0) == 0 && equals != std::string::npos;
		if (joined) {
			value = name.substr(equals + 1);
			name.resize(equals);
		}
		if (name == "--help" || name == "-h") {
			print_help();
			return false;
		}
		if (name == "--version") {
			printf("%s %s\n", program_.c_str(), PONG_VERSION);
			return false;
		}
		Option *option = find(name);
		if (!option)
			throw UsageError(std::string(name[0] == '-' ? "unknown option '" : "unexpected argument '") +
					 name + "'");
		const bool left_out = option->value_optional && !joined && (i + 1 == argc || argv[i + 1][0] == '-');
		if (option->value.empty() ? joined : !joined && !left_out && i + 1 == argc)
			throw UsageError(name + (joined ? " takes no value" : " needs a value: " + option->value));
		if (!option->value.empty() && !joined && !left_out)
			value = argv[++i];
		option->set(value);
		option->given = true;
	}
	return true;
}

void Options::print_help() const
{
	printf("usage: %s [OPTION ...]\n\n%s\n\nExample:\n%s\n\nOptions:\n", program_.c_str(), summary_.c_str(),
	       example_.c_str());
	for (const Option &option : options_) {
		const std::string left = option.name + (option.value.empty() ? "" : " ") + option.value;
		printf(left.size() < 24 ? "  %-23s %s\n" : "  %s\n                          %s\n", left.c_str(),
		       option.help.c_str());
	}
	printf("  --help                  print this and exit\n  --version               print the version and exit\n");
}

} // namespace pong
