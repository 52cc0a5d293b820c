// A line chart as SVG: axes, lines with names, nothing more.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace bench
{

struct Line {
	std::string name, colour;
	std::vector<std::array<double, 2>> points;
	bool dashed;
};

struct Axis {
	std::string label;
	double begin, end, tick; // begin may lie beyond end
};

// Throws pong::Failure where the file cannot be written.
void write_chart(const std::string &path, const std::string &title, const Axis &x, const Axis &y,
		 const std::vector<Line> &lines);

} // namespace bench
