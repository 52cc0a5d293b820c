// Command line options, declared once: parsed, checked and explained by --help from the same lines.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace pong
{

class Options
{
public:
	// `summary` is one sentence; `example` a worked example with real output, both for --help.
	Options(std::string program, std::string summary, std::string example);

	// --name VALUE. The help says what it is, with unit and default.
	void text(const char *name, const char *value, const char *help, std::string *target);
	// --name or --name VALUE; `value` in brackets. What begins with a dash is the next option.
	void optional_text(const char *name, const char *value, const char *help, std::string *target);
	void number(const char *name, const char *value, const char *help, double *target, double min, double max);
	void integer(const char *name, const char *value, const char *help, int *target, int min, int max);
	// --name, without a value.
	void flag(const char *name, const char *help, bool *target);
	// One of several words: sets *target to the word's place in the list.
	void choice(const char *name, std::vector<std::string> words, const char *help, int *target);

	// Throws UsageError. Returns false where --help or --version was asked for and has been printed.
	bool parse(int argc, char **argv);

	// Whether the option was given.
	bool given(const char *name) const;

private:
	struct Option {
		std::string name, value, help;
		std::function<void(const std::string &)> set;
		bool value_optional, given;
	};
	void add(const char *name, const std::string &value, const char *help,
		 std::function<void(const std::string &)> set);
	Option *find(const std::string &name);
	void print_help() const;

	std::string program_, summary_, example_;
	std::vector<Option> options_;
};

} // namespace pong
