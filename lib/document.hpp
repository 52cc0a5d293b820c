// A TOML file as the library reads it: every value is asked for by section and key, and whatever is wrong becomes one
// sentence with file, line and column.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace pong
{

// The text of a file. Throws Fault.
std::string read_file(const char *path);

class Document
{
public:
	// Throws Fault. `name` stands for the file in errors.
	Document(const std::string &text, const std::string &name);
	~Document();

	bool has_section(const char *section) const;
	bool has(const char *section, const char *key) const;

	// All throw Fault for a missing key, a wrong type, or a value outside of min .. max.
	double number(const char *section, const char *key, double min, double max) const;
	std::vector<double> numbers(const char *section, const char *key, size_t count) const;
	std::string text(const char *section, const char *key) const;

	// Throws Fault if the section has a key that is none of these: a misspelt key must not pass for an absent one.
	void allow_only(const char *section, const std::vector<std::string> &keys) const;

	// Throws a Fault that points at a section's key.
	[[noreturn]] void refuse(const char *section, const char *key, const std::string &why) const;

private:
	struct Implementation;
	std::unique_ptr<Implementation> implementation_;
};

} // namespace pong
