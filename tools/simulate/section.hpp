// Reading one TOML table with care: every value checked, every unknown key refused, with line and column.
#pragma once

#include <set>
#include <string>
#include <vector>

#define TOML_EXCEPTIONS 1
#include <toml++/toml.h>

namespace sim
{

class Section
{
public:
	// `table` may be null: then nothing is set. `name` is the file's, `prefix` goes before keys in errors.
	Section(const toml::table *table, std::string name, std::string prefix = "");

	// Each sets *target where the key is given, and else leaves it. They throw pong::Failure.
	void number(const char *key, double *target, double min, double max);
	void integer(const char *key, int *target, int min, int max);
	void flag(const char *key, bool *target);
	void text(const char *key, std::string *target);
	// The place of a word in the list.
	void choice(const char *key, const std::vector<std::string> &words, int *target);
	// `count` numbers.
	void numbers(const char *key, double *target, size_t count, double min, double max);
	// Any count of numbers, from one on.
	void list(const char *key, std::vector<double> *target, double min, double max);
	// The table under a key.
	Section section(const char *key);

	// Refuse what nobody asked for.
	void finish() const;

	// Throws pong::Failure: the file, the place of a key (or of the table), and a sentence.
	[[noreturn]] void fail(const std::string &key, const std::string &sentence) const;

private:
	const toml::node *find(const char *key);
	const toml::array *find_array(const char *key);
	double to_number(const toml::node &node, const std::string &key, double min, double max) const;
	[[noreturn]] void fail(const toml::source_region &place, const std::string &sentence) const;

	const toml::table *table_;
	std::string name_, prefix_;
	std::set<std::string> known_;
};

} // namespace sim
