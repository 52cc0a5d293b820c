// A tracker's points as text: a table with columns t x y z, several flights apart by a blank line or by a column
// `flight`. Read row by row, as they come.
#pragma once

#include <istream>
#include <string>
#include <vector>

#include "pongeye.h"

namespace predict
{

struct Row {
	std::string flight; // its name, or its number where it has none
	bool begins_flight; // the first usable row of it
	pong_point point;   // covariance zero where unknown
};

class PointReader
{
public:
	// `name` stands for the stream in errors. The stream is borrowed.
	PointReader(std::istream &stream, std::string name);

	// The next usable row; false at the end. Throws pong::Failure with the line for what is not a table.
	bool next(Row *row);

	// Rows that cannot be used: a coordinate that is absent or not finite, a time that does not go on.
	int64_t skipped() const
	{
		return skipped_;
	}
	// Columns that mean nothing here.
	const std::vector<std::string> &ignored() const
	{
		return ignored_;
	}

private:
	enum Column { T, UTIME, X, Y, Z, SX, SY, SZ, FLIGHT, COLUMNS };

	bool read_line();
	bool take_header();
	bool fill(Row *row);
	double number(Column column) const;
	[[noreturn]] void fail(const std::string &why) const;

	std::istream &stream_;
	std::string name_, line_;
	int64_t line_number_ = 0;
	std::vector<std::string> cells_;
	int place_[COLUMNS]; // of each column; -1: there is none
	size_t width_ = 0;   // columns of the table; 0: no header yet
	std::vector<std::string> ignored_;
	int64_t skipped_ = 0, flights_ = 0;
	bool apart_ = true; // a blank line, or the table's begin
	std::string flight_;
	int64_t last_utime_ = 0;
};

struct RecordedFlight {
	std::string name;
	std::vector<pong_point> points;
};

// All flights of a file; "-" is stdin. Throws pong::Failure.
std::vector<RecordedFlight> read_flights(const std::string &path);

} // namespace predict
