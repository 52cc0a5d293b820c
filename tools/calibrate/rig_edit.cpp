#include "rig_edit.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#define TOML_EXCEPTIONS 1
#include <toml++/toml.h>

#include "program.hpp"

namespace calibrate
{

namespace
{

// Lines and columns count from 1, columns in characters of UTF-8.
size_t offset_of(const std::string &text, const toml::source_position &position)
{
	size_t at = 0;
	for (toml::source_index line = 1; line < position.line; line++)
		at = text.find('\n', at) + 1;
	for (toml::source_index column = 1; column < position.column && at < text.size(); column++) {
		at++;
		while (at < text.size() && (text[at] & 0xc0) == 0x80)
			at++;
	}
	return at;
}

std::string written(const double P[3][4])
{
	std::string text = "[";
	for (int row = 0; row < 3; row++)
		for (int column = 0; column < 4; column++)
			text += pong::format("%s%.17g", column ? ", " : row ? ",\n     " : "", P[row][column]);
	return text + "]";
}

// To the last digits: P is written in full, but its scale may be set anew when it is read.
bool alike(const pong_camera &a, const pong_camera &b)
{
	for (int row = 0; row < 3; row++)
		for (int column = 0; column < 4; column++)
			if (std::abs(a.P[row][column] - b.P[row][column]) > 1e-9 * (1 + std::abs(b.P[row][column])))
				return false;
	return true;
}

// Whether two texts say the same but for a section.
bool alike_but_for(const std::string &section, const std::string &a, const std::string &b)
{
	try {
		toml::table one = toml::parse(a), other = toml::parse(b);
		one.erase(section);
		other.erase(section);
		return one == other;
	} catch (const toml::parse_error &) {
		return false;
	}
}

} // namespace

std::string read_text(const std::string &path)
{
	std::ifstream file(path);
	std::ostringstream text;
	if (!file || !(text << file.rdbuf()))
		throw pong::Failure(path + ": " + strerror(errno));
	return text.str();
}

std::string with_camera(const std::string &text, const std::string &path, pong_side side, const pong_camera &camera)
{
	const toml::table table = toml::parse(text, path);
	const toml::source_region &place = table[side == PONG_LEFT ? "left" : "right"]["P"].node()->source();
	const size_t begin = offset_of(text, place.begin), end = offset_of(text, place.end);
	const std::string result = text.substr(0, begin) + written(camera.P) + text.substr(end);
	pong_rig rig;
	if (pong_rig_parse(result.c_str(), path.c_str(), &rig, nullptr) < 0 || !alike(rig.camera[side], camera))
		throw pong::Failure(path + ": its P cannot be replaced in the way it is written there");
	return result;
}

std::string with_section(const std::string &text, const std::string &path, const std::string &name,
			 const std::string &section)
{
	std::istringstream lines(text);
	std::string result, line;
	bool inside = false;
	while (std::getline(lines, line)) {
		if (line.rfind('[', 0) == 0)
			inside = line.rfind("[" + name + "]", 0) == 0;
		if (!inside)
			result += line + "\n";
	}
	while (result.size() > 1 && result[result.size() - 2] == '\n')
		result.pop_back();
	result += "\n" + section;
	if (!alike_but_for(name, text, result))
		throw pong::Failure(path + ": its [" + name + "] cannot be replaced in the way it is written there");
	return result;
}

} // namespace calibrate
