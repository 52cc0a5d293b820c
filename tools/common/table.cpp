#include "table.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>

#include "program.hpp"

namespace pong
{

namespace
{

std::vector<std::string> split(const std::string &line)
{
	std::istringstream stream(line);
	std::vector<std::string> words;
	for (std::string word; stream >> word;)
		words.push_back(word);
	return words;
}

} // namespace

TableWriter::TableWriter(const std::string &path, const std::string &columns)
	: path_(path), file_(path == "-" ? stdout : fopen(path.c_str(), "w")), columns_(split(columns).size())
{
	if (!file_)
		throw Failure(path + ": " + strerror(errno));
	row_ = "# " + columns;
	filled_ = columns_;
	end_row();
}

TableWriter::~TableWriter()
{
	if (file_ != stdout)
		fclose(file_);
}

void TableWriter::add_text(const char *text)
{
	if (filled_++)
		row_ += ' ';
	row_ += text;
}

void TableWriter::add(int64_t value)
{
	char text[32];
	snprintf(text, sizeof text, "%lld", static_cast<long long>(value));
	add_text(text);
}

void TableWriter::add(double value, int decimals)
{
	char text[64];
	snprintf(text, sizeof text, "%.*f", decimals, value);
	add_text(std::isfinite(value) ? text : "-");
}

void TableWriter::add(const std::string &word)
{
	add_text(word.c_str());
}

void TableWriter::add_absent(int count)
{
	while (count-- > 0)
		add_text("-");
}

void TableWriter::end_row()
{
	if (filled_ != columns_)
		throw std::logic_error(path_ + ": a row has not as many cells as the table has columns");
	row_ += '\n';
	const bool written = fwrite(row_.data(), 1, row_.size(), file_) == row_.size() && fflush(file_) == 0;
	row_.clear();
	filled_ = 0;
	if (!written)
		throw Failure(path_ + ": cannot write: " + strerror(errno));
}

Table::Table(const std::string &path) : path_(path)
{
	std::ifstream file(path);
	if (!file)
		throw Failure(path + ": " + strerror(errno));
	std::string line;
	for (int number = 1; std::getline(file, line); number++) {
		std::vector<std::string> words = split(line);
		if (words.empty() || words[0].rfind("##", 0) == 0)
			continue;
		if (words[0][0] == '#') {
			if (names_.empty()) {
				words[0].erase(0, 1);
				names_.assign(words.begin() + (words[0].empty() ? 1 : 0), words.end());
			}
			continue;
		}
		if (words.size() != names_.size())
			throw Failure(format("%s:%d: %zu cells under %zu column names", path.c_str(), number,
					     words.size(), names_.size()));
		cells_.insert(cells_.end(), words.begin(), words.end());
	}
	if (names_.empty())
		throw Failure(path + ": no line '# name name ...' that names the columns");
}

size_t Table::rows() const
{
	return cells_.size() / names_.size();
}

size_t Table::column(const std::string &name) const
{
	const auto place = std::find(names_.begin(), names_.end(), name);
	if (place == names_.end())
		throw Failure(path_ + ": no column '" + name + "'");
	return static_cast<size_t>(place - names_.begin());
}

double Table::get(size_t row, size_t column) const
{
	const std::string &cell = cells_[row * names_.size() + column];
	if (cell == "-")
		return NAN;
	char *end;
	const double value = strtod(cell.c_str(), &end);
	if (*end)
		throw Failure(path_ + ": '" + cell + "' in column " + names_[column] + " is no number");
	return value;
}

int64_t Table::get_integer(size_t row, size_t column) const
{
	const std::string &cell = cells_[row * names_.size() + column];
	char *end;
	errno = 0;
	const long long value = strtoll(cell.c_str(), &end, 10);
	if (*end || end == cell.c_str() || errno)
		throw Failure(path_ + ": '" + cell + "' in column " + names_[column] + " is no whole number");
	return value;
}

} // namespace pong
