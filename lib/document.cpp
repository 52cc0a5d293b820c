#include "document.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <toml++/toml.h>

#include "error.hpp"

namespace pong
{

std::string read_file(const char *path)
{
	FILE *file = fopen(path, "rb");
	if (!file)
		throw Fault{PONG_ERROR_FILE, sentence("%s: %s", path, strerror(errno))};
	std::string text;
	char buffer[4096];
	for (size_t length; (length = fread(buffer, 1, sizeof buffer, file)) > 0;)
		text.append(buffer, length);
	const int fault = ferror(file) ? errno : 0;
	fclose(file);
	if (fault)
		throw Fault{PONG_ERROR_FILE, sentence("%s: %s", path, strerror(fault))};
	return text;
}

namespace
{

// NaN where it is no number. A whole number of more digits than a double has is rounded; toml++ would not give it.
double number_of(const toml::node &node)
{
	if (const auto *whole = node.as_integer())
		return static_cast<double>(whole->get());
	const auto *number = node.as_floating_point();
	return number ? number->get() : NAN;
}

} // namespace

struct Document::Implementation {
	std::string name;
	toml::table root;

	[[noreturn]] void refuse_at(const toml::source_position &where, int code, const std::string &why) const
	{
		throw Fault{code, sentence("%s:%u:%u: %s", name.c_str(), unsigned(where.line), unsigned(where.column),
					   why.c_str())};
	}

	const toml::table &section(const char *title) const
	{
		const toml::node *node = root.get(title);
		if (!node)
			throw Fault{PONG_ERROR_FORMAT, sentence("%s: section [%s] is missing", name.c_str(), title)};
		if (!node->is_table())
			refuse_at(node->source().begin, PONG_ERROR_FORMAT,
				  sentence("%s must be a section: [%s]", title, title));
		return *node->as_table();
	}

	const toml::node &node(const char *title, const char *key) const
	{
		const toml::table &table = section(title);
		const toml::node *found = table.get(key);
		if (!found)
			refuse_at(table.source().begin, PONG_ERROR_FORMAT, sentence("%s.%s is missing", title, key));
		return *found;
	}
};

Document::Document(const std::string &text, const std::string &name) : implementation_(new Implementation{name, {}})
{
	try {
		implementation_->root = toml::parse(text, name);
	} catch (const toml::parse_error &error) {
		implementation_->refuse_at(error.source().begin, PONG_ERROR_FORMAT, std::string(error.description()));
	}
}

Document::~Document() = default;

bool Document::has_section(const char *section) const
{
	return implementation_->root.contains(section);
}

bool Document::has(const char *section, const char *key) const
{
	return has_section(section) && implementation_->section(section).contains(key);
}

void Document::refuse(const char *section, const char *key, const std::string &why) const
{
	const auto &where = implementation_->node(section, key).source().begin;
	implementation_->refuse_at(where, PONG_ERROR_VALUE, sentence("%s.%s %s", section, key, why.c_str()));
}

double Document::number(const char *section, const char *key, double min, double max) const
{
	const toml::node &node = implementation_->node(section, key);
	if (!node.is_number())
		implementation_->refuse_at(node.source().begin, PONG_ERROR_FORMAT,
					   sentence("%s.%s needs a number", section, key));
	const double value = number_of(node);
	if (!(value >= min && value <= max))
		refuse(section, key, sentence("must lie between %g and %g, is %g", min, max, value));
	return value;
}

std::vector<double> Document::numbers(const char *section, const char *key, size_t count) const
{
	const toml::node &node = implementation_->node(section, key);
	const toml::array *array = node.as_array();
	if (!array || array->size() != count)
		implementation_->refuse_at(node.source().begin, PONG_ERROR_FORMAT,
					   sentence("%s.%s needs %zu numbers, has %zu", section, key, count,
						    array ? array->size() : size_t{1}));
	std::vector<double> values;
	for (const toml::node &element : *array) {
		const double value = number_of(element);
		if (!std::isfinite(value))
			implementation_->refuse_at(element.source().begin, PONG_ERROR_FORMAT,
						   sentence("%s.%s needs finite numbers", section, key));
		values.push_back(value);
	}
	return values;
}

std::string Document::text(const char *section, const char *key) const
{
	const toml::node &node = implementation_->node(section, key);
	if (!node.is_string())
		implementation_->refuse_at(node.source().begin, PONG_ERROR_FORMAT,
					   sentence("%s.%s needs a text in quotes", section, key));
	return node.value<std::string>().value_or("");
}

void Document::allow_only(const char *section, const std::vector<std::string> &keys) const
{
	for (const auto &[key, node] : implementation_->section(section))
		if (std::find(keys.begin(), keys.end(), std::string(key.str())) == keys.end())
			implementation_->refuse_at(
				key.source().begin, PONG_ERROR_FORMAT,
				sentence("[%s] has no key '%s'", section, std::string(key.str()).c_str()));
}

} // namespace pong
