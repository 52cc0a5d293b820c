#include "points.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>

#include "program.hpp"

namespace predict
{

namespace
{

const size_t line_longest = 65536;
const double utime_largest = 2e18;     // differences still fit into 64 bits
const double coordinate_largest = 1e6; // m: no ball is there
const std::vector<std::string> names = {"t", "utime", "x", "y", "z", "sx", "sy", "sz", "flight"};

// Words between blanks or commas.
void split(const std::string &line, std::vector<std::string> &words)
{
	const char *between = " \t\r,";
	words.clear();
	for (size_t begin = line.find_first_not_of(between); begin != std::string::npos;) {
		const size_t end = std::min(line.find_first_of(between, begin), line.size());
		words.push_back(line.substr(begin, end - begin));
		begin = line.find_first_not_of(between, end);
	}
}

} // namespace

PointReader::PointReader(std::istream &stream, std::string name) : stream_(stream), name_(std::move(name))
{
	std::fill_n(place_, static_cast<int>(COLUMNS), -1);
}

bool PointReader::next(Row *row)
{
	while (read_line()) {
		if (cells_.empty()) {
			apart_ = true;
			continue;
		}
		if (take_header())
			continue;
		if (cells_.size() != width_)
			fail(pong::format("has %zu columns, the table %zu", cells_.size(), width_));
		if (fill(row))
			return true;
		skipped_++;
	}
	return false;
}

bool PointReader::read_line()
{
	if (!std::getline(stream_, line_))
		return false;
	line_number_++;
	if (line_.size() > line_longest)
		fail(pong::format("is longer than %zu bytes", line_longest));
	split(line_, cells_);
	return true;
}

// The first line names the columns, with or without a # in front. Later lines that begin with # are comments.
bool PointReader::take_header()
{
	const bool hash = cells_[0][0] == '#';
	if (width_ > 0)
		return hash;
	if (hash) {
		cells_[0].erase(0, 1);
		if (cells_[0].empty())
			cells_.erase(cells_.begin());
	}
	for (size_t i = 0; i < cells_.size(); i++) {
		const auto known = std::find(names.begin(), names.end(), cells_[i]);
		if (known == names.end())
			ignored_.push_back(cells_[i]);
		else if (place_[known - names.begin()] >= 0)
			fail("names column '" + cells_[i] + "' twice");
		else
			place_[known - names.begin()] = static_cast<int>(i);
	}
	if (place_[T] < 0 && place_[UTIME] < 0)
		fail("names no column 't': the first line must name the columns, as in '# t x y z'");
	for (const Column column : {X, Y, Z})
		if (place_[column] < 0)
			fail("names no column '" + names[column] +
			     "': the first line must name the columns, as in '# t x y z'");
	width_ = cells_.size();
	return true;
}

bool PointReader::fill(Row *row)
{
	const double t = place_[T] >= 0 ? 1e6 * number(T) : number(UTIME);
	double position[3], sigma[3] = {0, 0, 0};
	bool usable = std::abs(t) < utime_largest;
	for (int axis = 0; axis < 3; axis++) {
		position[axis] = number(static_cast<Column>(X + axis));
		usable = usable && std::abs(position[axis]) < coordinate_largest;
		if (place_[SX + axis] >= 0)
			sigma[axis] = number(static_cast<Column>(SX + axis));
	}
	if (!usable)
		return false;
	const std::string &name = place_[FLIGHT] >= 0 ? cells_[static_cast<size_t>(place_[FLIGHT])] : flight_;
	row->begins_flight = apart_ || name != flight_;
	const int64_t utime = std::llround(t);
	if (!row->begins_flight && utime <= last_utime_)
		return false;
	if (row->begins_flight) {
		flight_ = place_[FLIGHT] >= 0 ? name : std::to_string(flights_);
		flights_++;
	}
	apart_ = false;
	last_utime_ = utime;
	row->flight = flight_;
	row->point = {};
	row->point.utime = utime;
	std::copy_n(position, 3, row->point.position);
	if (sigma[0] > 0 && sigma[1] > 0 && sigma[2] > 0 && std::isfinite(sigma[0] + sigma[1] + sigma[2]))
		for (int axis = 0; axis < 3; axis++)
			row->point.covariance[axis][axis] = sigma[axis] * sigma[axis];
	return true;
}

double PointReader::number(Column column) const
{
	const std::string &cell = cells_[static_cast<size_t>(place_[column])];
	if (cell == "-")
		return NAN;
	char *end;
	const double value = strtod(cell.c_str(), &end);
	if (*end || cell.empty())
		fail(names[column] + " is '" + cell + "', not a number");
	return value;
}

void PointReader::fail(const std::string &why) const
{
	throw pong::Failure(
		pong::format("%s:%lld: %s", name_.c_str(), static_cast<long long>(line_number_), why.c_str()));
}

std::vector<RecordedFlight> read_flights(const std::string &path)
{
	std::ifstream file;
	if (path != "-") {
		file.open(path);
		if (!file)
			throw pong::Failure(path + ": " + strerror(errno));
	}
	PointReader reader(path == "-" ? std::cin : file, path == "-" ? "stdin" : path);
	std::vector<RecordedFlight> flights;
	Row row;
	while (reader.next(&row)) {
		if (row.begins_flight)
			flights.push_back({row.flight, {}});
		flights.back().points.push_back(row.point);
	}
	return flights;
}

} // namespace predict
