#include "section.hpp"

#include <algorithm>
#include <cmath>

#include "program.hpp"

namespace sim
{

using pong::format;

Section::Section(const toml::table *table, std::string name, std::string prefix)
	: table_(table), name_(std::move(name)), prefix_(std::move(prefix))
{
}

void Section::fail(const toml::source_region &place, const std::string &sentence) const
{
	throw pong::Failure(format("%s:%u:%u: %s", name_.c_str(), static_cast<unsigned>(place.begin.line),
				   static_cast<unsigned>(place.begin.column), sentence.c_str()));
}

void Section::fail(const std::string &key, const std::string &sentence) const
{
	const toml::node *node = table_ ? table_->get(key) : nullptr;
	if (node)
		fail(node->source(), prefix_ + key + " " + sentence);
	throw pong::Failure(name_ + ": " + prefix_ + key + " " + sentence);
}

const toml::node *Section::find(const char *key)
{
	known_.insert(key);
	return table_ ? table_->get(key) : nullptr;
}

const toml::array *Section::find_array(const char *key)
{
	const toml::node *node = find(key);
	if (node && !node->is_array())
		fail(key, "needs a list of numbers");
	return node ? node->as_array() : nullptr;
}

double Section::to_number(const toml::node &node, const std::string &key, double min, double max) const
{
	const auto value = node.is_number() ? node.value<double>() : std::nullopt;
	if (!value || !std::isfinite(*value))
		fail(node.source(), prefix_ + key + " needs a number");
	if (*value < min || *value > max)
		fail(node.source(),
		     format("%s%s must lie between %g and %g, not %g", prefix_.c_str(), key.c_str(), min, max, *value));
	return *value;
}

void Section::number(const char *key, double *target, double min, double max)
{
	if (const toml::node *node = find(key))
		*target = to_number(*node, key, min, max);
}

void Section::integer(const char *key, int *target, int min, int max)
{
	const toml::node *node = find(key);
	if (!node)
		return;
	if (!node->is_integer())
		fail(key, "needs a whole number");
	*target = static_cast<int>(to_number(*node, key, min, max));
}

void Section::flag(const char *key, bool *target)
{
	const toml::node *node = find(key);
	if (!node)
		return;
	if (!node->is_boolean())
		fail(key, "is true or false");
	*target = node->value_or(false);
}

void Section::text(const char *key, std::string *target)
{
	const toml::node *node = find(key);
	if (!node)
		return;
	if (!node->is_string())
		fail(key, "needs a text in quotes");
	*target = node->value_or("");
}

void Section::choice(const char *key, const std::vector<std::string> &words, int *target)
{
	if (!find(key))
		return;
	std::string chosen;
	text(key, &chosen);
	const auto word = std::find(words.begin(), words.end(), chosen);
	if (word == words.end()) {
		std::string list;
		for (const std::string &known : words)
			list += (list.empty() ? "" : ", ") + known;
		fail(key, "is one of " + list + ", not '" + chosen + "'");
	}
	*target = static_cast<int>(word - words.begin());
}

void Section::numbers(const char *key, double *target, size_t count, double min, double max)
{
	const toml::array *array = find_array(key);
	if (!array)
		return;
	if (array->size() != count)
		fail(key, format("needs %zu numbers, has %zu", count, array->size()));
	for (size_t i = 0; i < count; i++)
		target[i] = to_number((*array)[i], key, min, max);
}

void Section::list(const char *key, std::vector<double> *target, double min, double max)
{
	const toml::array *array = find_array(key);
	if (!array)
		return;
	target->clear();
	for (const toml::node &node : *array)
		target->push_back(to_number(node, key, min, max));
}

Section Section::section(const char *key)
{
	const toml::node *node = find(key);
	if (node && !node->is_table())
		fail(key, "needs to be a section");
	return Section(node ? node->as_table() : nullptr, name_, prefix_ + key + ".");
}

void Section::finish() const
{
	if (!table_)
		return;
	for (const auto &[key, node] : *table_)
		if (!known_.count(std::string(key.str())))
			fail(key.source(), "there is no setting '" + prefix_ + std::string(key.str()) + "'");
}

} // namespace sim
