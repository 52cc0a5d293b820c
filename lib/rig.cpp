// rig.toml: read, checked, written.
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>

#include "camera.hpp"
#include "document.hpp"
#include "error.hpp"
#include "pongeye.h"

namespace pong
{

namespace
{

const double unbounded = std::numeric_limits<double>::max();

// Today's ball and air; the drag is the middle of what recorded flights show.
const pong_ball_spec usual_ball = {0.040, 0.0027, 0.50, 1.2, {0.8, -0.96, 0.8}};
const pong_table usual_table = {1, 2.74, 1.525};

void read_number(const Document &document, const char *section, const char *key, double min, double max, double *value)
{
	if (document.has(section, key))
		*value = document.number(section, key, min, max);
}

pong_ball_spec read_ball(const Document &document)
{
	pong_ball_spec ball = usual_ball;
	if (!document.has_section("ball"))
		return ball;
	document.allow_only("ball", {"diameter", "mass", "drag", "air_density", "bounce"});
	read_number(document, "ball", "diameter", 0.001, 1, &ball.diameter);
	read_number(document, "ball", "mass", 0.0001, 10, &ball.mass);
	read_number(document, "ball", "drag", 0, 10, &ball.drag);
	read_number(document, "ball", "air_density", 0, 100, &ball.air_density);
	if (document.has("ball", "bounce")) {
		const auto bounce = document.numbers("ball", "bounce", 3);
		if (bounce[1] > 0 || bounce[1] < -1)
			document.refuse("ball", "bounce",
					"turns the ball: its second number must lie between -1 and 0");
		std::copy(bounce.begin(), bounce.end(), ball.bounce);
	}
	return ball;
}

pong_table read_table(const Document &document)
{
	if (!document.has_section("table"))
		return {0, 0, 0};
	pong_table table = usual_table;
	document.allow_only("table", {"length", "width"});
	read_number(document, "table", "length", 0.1, 100, &table.length);
	read_number(document, "table", "width", 0.1, 100, &table.width);
	return table;
}

// Scale P so that its third row gives the depth in metres: its left part then is a unit vector along the optical axis.
void normalise(const Document &document, const char *section, double P[3][4])
{
	Matrix34 matrix = matrix_of(P);
	const double determinant = matrix.leftCols<3>().determinant();
	const double scale = matrix.row(2).head<3>().norm();
	if (!(scale > 0) || !(std::abs(determinant) > 1e-9 * std::pow(matrix.leftCols<3>().norm(), 3)))
		document.refuse(section, "P", "is not a camera: its left 3x3 part cannot be inverted");
	matrix /= determinant > 0 ? scale : -scale;
	store(matrix, P);
}

pong_camera read_camera(const Document &document, const char *section)
{
	pong_camera camera = {};
	document.allow_only(section, {"camera", "size", "P", "distortion"});
	if (document.has(section, "camera")) {
		const std::string id = document.text(section, "camera");
		if (id.size() >= sizeof camera.id)
			document.refuse(section, "camera",
					sentence("is longer than %zu letters", sizeof camera.id - 1));
		memcpy(camera.id, id.c_str(), id.size() + 1);
	}
	const auto size = document.numbers(section, "size", 2);
	for (const double side : size)
		if (side < 16 || side > 16384 || side != std::floor(side))
			document.refuse(section, "size", "needs whole numbers between 16 and 16384");
	camera.width = static_cast<int>(size[0]);
	camera.height = static_cast<int>(size[1]);
	const auto P = document.numbers(section, "P", 12);
	std::copy(P.begin(), P.end(), &camera.P[0][0]);
	normalise(document, section, camera.P);
	if (document.has(section, "distortion")) {
		const auto distortion = document.numbers(section, "distortion", 5);
		std::copy(distortion.begin(), distortion.end(), camera.distortion);
	}
	return camera;
}

pong_rig read_rig(const Document &document)
{
	pong_rig rig = {};
	rig.ball = read_ball(document);
	rig.table = read_table(document);
	if (document.has_section("hit")) {
		document.allow_only("hit", {"z"});
		read_number(document, "hit", "z", -unbounded, unbounded, &rig.hit_z);
	}
	rig.camera[PONG_LEFT] = read_camera(document, "left");
	rig.camera[PONG_RIGHT] = read_camera(document, "right");
	return rig;
}

// As many digits as bring back the same number.
std::string digits(double value)
{
	char text[32];
	for (int precision = 1; precision <= 17; precision++) {
		snprintf(text, sizeof text, "%.*g", precision, value);
		if (strtod(text, nullptr) == value)
			break;
	}
	return text;
}

std::string list(const double *values, int count, int per_line)
{
	std::string text = "[";
	for (int i = 0; i < count; i++)
		text += (i == 0 ? "" : i % per_line ? ", " : ",\n     ") + digits(values[i]);
	return text + "]";
}

std::string quoted(const std::string &text)
{
	std::string result = "\"";
	for (const char letter : text) {
		if (letter == '"' || letter == '\\')
			result += '\\';
		result += letter;
	}
	return result + "\"";
}

std::string write_camera(const pong_camera &camera, const char *section)
{
	return std::string("\n[") + section + "]\n" + (camera.id[0] ? "camera = " + quoted(camera.id) + "\n" : "") +
	       sentence("size = [%d, %d]\n", camera.width, camera.height) + "P = " + list(&camera.P[0][0], 12, 4) +
	       "\ndistortion = " + list(camera.distortion, 5, 5) + "\n";
}

std::string write_rig(const pong_rig &rig)
{
	std::string text = "[ball]\ndiameter = " + digits(rig.ball.diameter) + "\nmass = " + digits(rig.ball.mass) +
			   "\ndrag = " + digits(rig.ball.drag) + "\nair_density = " + digits(rig.ball.air_density) +
			   "\nbounce = " + list(rig.ball.bounce, 3, 3) + "\n";
	if (rig.table.present)
		text += "\n[table]\nlength = " + digits(rig.table.length) + "\nwidth = " + digits(rig.table.width) +
			"\n";
	return text + "\n[hit]\nz = " + digits(rig.hit_z) + "\n" + write_camera(rig.camera[PONG_LEFT], "left") +
	       write_camera(rig.camera[PONG_RIGHT], "right");
}

} // namespace

} // namespace pong

int pong_rig_parse(const char *text, const char *name, pong_rig *rig, pong_error *error)
{
	return pong::guarded(error, [&] {
		*rig = pong::read_rig(pong::Document(text, name));
		return PONG_FOUND;
	});
}

int pong_rig_load(const char *path, pong_rig *rig, pong_error *error)
{
	return pong::guarded(error, [&] {
		*rig = pong::read_rig(pong::Document(pong::read_file(path), path));
		return PONG_FOUND;
	});
}

int pong_rig_format(const pong_rig *rig, char *text, int capacity)
{
	return snprintf(text, static_cast<size_t>(capacity), "%s", pong::write_rig(*rig).c_str());
}
