#include "chart.hpp"

#include <cmath>
#include <fstream>

#include "program.hpp"

namespace bench
{

namespace
{

const double width = 640, height = 360, left = 60, right = 20, top = 36, bottom = 48; // px

double x_of(const Axis &axis, double value)
{
	return left + (width - left - right) * (value - axis.begin) / (axis.end - axis.begin);
}

double y_of(const Axis &axis, double value)
{
	return height - bottom - (height - top - bottom) * (value - axis.begin) / (axis.end - axis.begin);
}

std::string text(double x, double y, const char *anchor, const std::string &words, const std::string &colour)
{
	return pong::format("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" fill=\"%s\">", x, y, anchor,
			    colour.c_str()) +
	       words + "</text>\n";
}

std::string ticks(const Axis &axis, bool upright)
{
	std::string svg;
	const int count = static_cast<int>(std::floor(std::abs(axis.end - axis.begin) / axis.tick + 0.5));
	for (int i = 0; i <= count; i++) {
		const double value = axis.begin + (axis.end > axis.begin ? i : -i) * axis.tick;
		const std::string label = pong::format("%g", std::abs(value) < 1e-9 ? 0.0 : value);
		if (upright) {
			const double y = y_of(axis, value);
			svg += pong::format("<path d=\"M%.1f %.1fH%.1f\" stroke=\"#ddd\"/>\n", left, y, width - right);
			svg += text(left - 6, y + 4, "end", label, "#333");
		} else {
			svg += text(x_of(axis, value), height - bottom + 18, "middle", label, "#333");
		}
	}
	return svg;
}

std::string path_of(const Line &line, const Axis &x, const Axis &y)
{
	std::string svg = "<path fill=\"none\" stroke-width=\"1.5\" stroke=\"" + line.colour + "\"" +
			  (line.dashed ? " stroke-dasharray=\"5 3\"" : "") + " d=\"";
	for (size_t i = 0; i < line.points.size(); i++)
		svg += pong::format("%c%.1f %.1f", i ? 'L' : 'M', x_of(x, line.points[i][0]),
				    y_of(y, line.points[i][1]));
	return svg + "\"/>\n";
}

} // namespace

void write_chart(const std::string &path, const std::string &title, const Axis &x, const Axis &y,
		 const std::vector<Line> &lines)
{
	std::string svg = pong::format(
		"<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %g %g\" font-family=\"sans-serif\" "
		"font-size=\"12\">\n<rect width=\"%g\" height=\"%g\" fill=\"white\"/>\n",
		width, height, width, height);
	svg += text(left, 20, "start", title, "#000") + ticks(y, true) + ticks(x, false);
	svg += text((left + width - right) / 2, height - 10, "middle", x.label, "#333");
	svg += pong::format(
		"<text transform=\"translate(14 %.1f) rotate(-90)\" text-anchor=\"middle\" fill=\"#333\">%s</text>\n",
		(top + height - bottom) / 2, y.label.c_str());
	double row = 0.3 * height;
	for (const Line &line : lines) {
		svg += path_of(line, x, y);
		if (line.name.empty())
			continue;
		svg += text(width - right - 8, row, "end", line.name, line.colour);
		row += 16;
	}
	std::ofstream file(path);
	if (!(file << svg << "</svg>\n"))
		throw pong::Failure(path + " cannot be written");
}

} // namespace bench
