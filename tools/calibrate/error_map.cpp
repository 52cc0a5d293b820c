#include "error_map.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "program.hpp"

namespace calibrate
{

namespace
{

using pong::format;

const double picture_width = 680, left_margin = 64, right_margin = 40, top_margin = 92,
	     bottom_margin = 56; // units of SVG
const double least_step = 34;    // between rows, units

struct Cell {
	double sum = 0;
	int count = 0;
};

// Places by their coordinates to the right and up, both in centimetres.
using Cells = std::map<std::pair<int, int>, Cell>;

// The coordinates along an axis, cm; where there are too many to write down, the nearest of nine instead.
std::vector<int> coordinates(const Volume &volume, size_t axis)
{
	std::vector<int> values;
	for (const ExpectedError &place : volume.places)
		values.push_back(static_cast<int>(std::lround(100 * place.position[axis])));
	if (std::set<int>(values.begin(), values.end()).size() <= 14)
		return values;
	const auto [low, high] = std::minmax_element(values.begin(), values.end());
	const double first = *low, step = (*high - *low) / 8.0;
	for (int &value : values)
		value = static_cast<int>(std::lround(first + step * std::round((value - first) / step)));
	return values;
}

Cells cells_of(const Volume &volume, const MapAxes &axes)
{
	const std::vector<int> right = coordinates(volume, axes.right), up = coordinates(volume, axes.up);
	Cells cells;
	for (size_t i = 0; i < volume.places.size(); i++) {
		Cell &cell = cells[{right[i], up[i]}];
		if (std::isfinite(volume.places[i].total)) {
			cell.sum += volume.places[i].total;
			cell.count++;
		}
	}
	return cells;
}

// Green for a millimetre or less, over yellow, to red for ten and more; grey where not both cameras see.
std::string colour(double error)
{
	if (!std::isfinite(error))
		return "#e8e8e8";
	const double part = std::clamp(std::log10(error), 0.0, 1.0);
	return format("hsl(%.0f,70%%,62%%)", 130 * (1 - part));
}

std::string text_at(double x, double y, const char *anchor, const std::string &text, int size = 13)
{
	return format("<text x='%.1f' y='%.1f' font-size='%d' text-anchor='%s'>%s</text>", x, y, size, anchor,
		      text.c_str());
}

std::string box(double x, double y, double width, double height, const std::string &fill)
{
	return format("<rect x='%.1f' y='%.1f' width='%.1f' height='%.1f' rx='4' fill='%s'/>", x, y, width, height,
		      fill.c_str());
}

// Where a coordinate, cm, is drawn.
struct Scale {
	int low, high;
	double from, to;

	double at(int value) const
	{
		return high > low ? from + (to - from) * (value - low) / (high - low) : (from + to) / 2;
	}
};

std::string legend(double y)
{
	std::string svg;
	const double levels[] = {1, 2, 5, 10};
	const char *const names[] = {"1 mm or less", "2", "5", "10 or more"};
	double x = left_margin - 20;
	for (size_t i = 0; i < 4; i++) {
		svg += box(x, y - 11, 16, 14, colour(levels[i])) + text_at(x + 21, y, "start", names[i], 12);
		x += i == 0 ? 112 : 46;
	}
	x += 50;
	return svg + box(x, y - 11, 16, 14, colour(NAN)) + text_at(x + 21, y, "start", "not in view of both", 12);
}

} // namespace

std::string error_map(const Volume &volume, const MapAxes &axes, const std::string &title)
{
	const Cells cells = cells_of(volume, axes);
	std::map<int, int> across, upward; // the coordinates that occur
	for (const auto &[place, cell] : cells) {
		across[place.first]++;
		upward[place.second]++;
	}
	const double rows = static_cast<double>(upward.size()) - 1;
	const double height = top_margin + std::max(rows * least_step, 60.0) + bottom_margin;
	// The table frame's x runs to the robot's left.
	const bool mirrored = axes.right == 0;
	const double begin = left_margin + 30, end = picture_width - right_margin;
	const Scale x = {across.begin()->first, across.rbegin()->first, mirrored ? end : begin, mirrored ? begin : end};
	const Scale y = {upward.begin()->first, upward.rbegin()->first, height - bottom_margin, top_margin};
	const double wide =
		std::clamp((end - begin) / std::max<double>(static_cast<double>(across.size()) - 1, 1) - 4, 10.0, 60.0);
	std::string svg =
		format("<svg viewBox='0 0 %.0f %.0f' font-family='system-ui,sans-serif'>", picture_width, height) +
		text_at(0, 18, "start", title, 16) + legend(42);
	for (const auto &[place, cell] : cells) {
		const double error = cell.count ? cell.sum / cell.count : NAN;
		svg += box(x.at(place.first) - wide / 2, y.at(place.second) - 13, wide, 26, colour(error));
		svg += text_at(x.at(place.first), y.at(place.second) + 4.5, "middle",
			       cell.count ? format("%.1f", error) : "&#8211;");
	}
	const char names[] = "xyz";
	for (const auto &[value, count] : across)
		svg += text_at(x.at(value), height - bottom_margin + 32, "middle", format("%.2f", value / 100.0), 12);
	for (const auto &[value, count] : upward)
		svg += text_at(left_margin - 20, y.at(value) + 4.5, "end", format("%.2f", value / 100.0), 12);
	svg += text_at((begin + end) / 2, height - 6, "middle", format("%c, m", names[axes.right]));
	svg += text_at(left_margin - 20, top_margin - 20, "end", format("%c, m", names[axes.up]));
	return svg + "</svg>";
}

} // namespace calibrate
