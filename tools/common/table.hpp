// Tables as text: a line `# name name`, then rows; `-` for what is absent (the vnlog form).
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace pong
{

// Writes rows to a file or, for "-", to stdout. Every row is flushed: whoever reads along sees it at once.
class TableWriter
{
public:
	TableWriter(const std::string &path, const std::string &columns);
	~TableWriter();
	TableWriter(const TableWriter &) = delete;
	TableWriter &operator=(const TableWriter &) = delete;

	void add(int64_t value);
	void add(double value, int decimals = 6); // NaN is absent
	void add(const std::string &word);        // without blanks
	void add_absent(int count = 1);
	// Throws Failure where the disk is full.
	void end_row();

private:
	void add_text(const char *text);

	std::string path_;
	FILE *file_;
	size_t columns_, filled_ = 0;
	std::string row_;
};

// A whole table in memory.
class Table
{
public:
	// Throws Failure with file and line for what is not a table.
	explicit Table(const std::string &path);

	size_t rows() const;
	// The place of a column. Throws Failure, naming the file, where there is none.
	size_t column(const std::string &name) const;
	// A number; NaN where absent.
	double get(size_t row, size_t column) const;
	// A whole number, exactly: utimes do not fit a double's digits for ever.
	int64_t get_integer(size_t row, size_t column) const;

private:
	std::string path_;
	std::vector<std::string> names_;
	std::vector<std::string> cells_; // row by row
};

} // namespace pong
