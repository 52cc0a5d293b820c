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

// Today's ball and air; the coefficients and their spread are what recorded flights show (docs/predict.md).
pong_ball_spec usual_ball()
{
	pong_ball_spec ball = {};
	ball.diameter = 0.040;
	ball.mass = 0.0027;
	ball.drag = 0.40;
	ball.drag_by_spin = 0.13;
	ball.drag_sigma = 0.04;
	ball.air_density = 1.2;
	ball.bounce[0] = ball.bounce[2] = 0.8;
	ball.bounce[1] = -0.96;
	ball.magnus = 15e-6;
	ball.magnus_sigma = 1.5e-6;
	ball.magnus_saturation = 2;
	ball.restitution = 0.92;
	ball.restitution_sigma = 0.03;
	ball.friction = 0.257;
	ball.friction_sigma = 0.04;
	ball.grip = 0.15;
	ball.grip_sigma = 0.1;
	ball.kick = 0.02;
	ball.spin_sigma[0] = 150;
	ball.spin_sigma[1] = ball.spin_sigma[2] = 50;
	return ball;
}

const pong_table usual_table = {1, 2.74, 1.525, 0.1525, 0, 0.002};

void read_number(const Document &document, const char *section, const char *key, double min, double max, double *value)
{
	if (document.has(section, key))
		*value = document.number(section, key, min, max);
}

// A coefficient of the flight: its key, its place, and what it may be.
struct Coefficient {
	const char *key;
	double pong_ball_spec::*value;
	double min, max;
};

const Coefficient coefficients[] = {
	{"drag", &pong_ball_spec::drag, 0, 10},
	{"drag_sigma", &pong_ball_spec::drag_sigma, 0, 10},
	{"drag_by_spin", &pong_ball_spec::drag_by_spin, 0, 10},
	{"magnus", &pong_ball_spec::magnus, 0, 1},
	{"magnus_saturation", &pong_ball_spec::magnus_saturation, 0, 100},
	{"magnus_sigma", &pong_ball_spec::magnus_sigma, 0, 1},
	{"restitution", &pong_ball_spec::restitution, 0, 1},
	{"restitution_sigma", &pong_ball_spec::restitution_sigma, 0, 1},
	{"friction", &pong_ball_spec::friction, 0, 10},
	{"friction_sigma", &pong_ball_spec::friction_sigma, 0, 10},
	{"grip", &pong_ball_spec::grip, -1, 1},
	{"grip_sigma", &pong_ball_spec::grip_sigma, 0, 1},
	{"kick", &pong_ball_spec::kick, 0, 10},
};

// A length of the table, likewise, m.
struct Length {
	const char *key;
	double pong_table::*value;
	double min, max;
};

const Length table_lengths[] = {
	{"length", &pong_table::length, 0.1, 100},
	{"width", &pong_table::width, 0.1, 100},
	{"net", &pong_table::net, 0, 10},
	{"height", &pong_table::height, -1, 1},
	{"height_sigma", &pong_table::height_sigma, 0, 1},
};

pong_ball_spec read_ball(const Document &document)
{
	pong_ball_spec ball = usual_ball();
	if (!document.has_section("ball"))
		return ball;
	document.allow_only("ball", {"diameter", "mass", "air_density", "bounce", "drag", "drag_sigma", "drag_by_spin",
				     "magnus", "magnus_sigma", "magnus_saturation", "restitution", "restitution_sigma",
				     "friction", "friction_sigma", "grip", "grip_sigma", "kick", "spin_sigma"});
	read_number(document, "ball", "diameter", 0.001, 1, &ball.diameter);
	read_number(document, "ball", "mass", 0.0001, 10, &ball.mass);
	read_number(document, "ball", "air_density", 0, 100, &ball.air_density);
	for (const Coefficient &coefficient : coefficients)
		read_number(document, "ball", coefficient.key, coefficient.min, coefficient.max,
			    &(ball.*coefficient.value));
	if (document.has("ball", "spin_sigma")) {
		const auto sigma = document.numbers("ball", "spin_sigma", 3);
		for (const double one : sigma)
			if (!(one >= 0 && one <= 10000))
				document.refuse("ball", "spin_sigma", "needs numbers between 0 and 10000 rad/s");
		std::copy(sigma.begin(), sigma.end(), ball.spin_sigma);
	}
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
		return {};
	pong_table table = usual_table;
	document.allow_only("table", {"length", "width", "net", "height", "height_sigma"});
	for (const Length &length : table_lengths)
		read_number(document, "table", length.key, length.min, length.max, &(table.*length.value));
	return table;
}

// Scale P so that its third row gives the depth in metres: its left part then is a unit vector along the optical axis.
// One that is so already but for rounding stays to the last digit, and what is asked of a camera is asked of the scaled
// one: a rig that is written and read again is the same.
void normalise(const Document &document, const char *section, double P[3][4])
{
	Matrix34 matrix = matrix_of(P);
	const auto axis = matrix.row(2).head<3>();
	const auto is_unit = [&axis] { return std::abs(axis.norm() - 1) < 1e-12; };
	if (!is_unit())
		matrix /= axis.norm();
	const double determinant = matrix.leftCols<3>().determinant();
	if (!is_unit() || !(std::abs(determinant) > 1e-9 * std::pow(matrix.leftCols<3>().norm(), 3)))
		document.refuse(section, "P", "is not a camera: its left 3x3 part cannot be inverted");
	if (!matrix.allFinite())
		document.refuse(section, "P", "is not a camera: its last column is too large");
	if (determinant < 0)
		matrix = -matrix;
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

// All but the cameras.
pong_rig read_flight(const Document &document)
{
	pong_rig rig = {};
	rig.ball = read_ball(document);
	rig.table = read_table(document);
	if (document.has_section("hit")) {
		document.allow_only("hit", {"z"});
		read_number(document, "hit", "z", -unbounded, unbounded, &rig.hit_z);
	}
	return rig;
}

pong_rig read_rig(const Document &document)
{
	pong_rig rig = read_flight(document);
	rig.camera[PONG_LEFT] = read_camera(document, "left");
	rig.camera[PONG_RIGHT] = read_camera(document, "right");
	return rig;
}

// As many digits as bring back the same number: 15 always say what a person wrote. Zero has no sign: TOML's -0 is a
// whole number, and read as 0.
std::string digits(double value)
{
	char text[32];
	if (value == 0)
		return "0";
	for (int precision = 15; precision <= 17; precision++) {
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

// As a TOML text: quotes and backslashes are escaped, and so are control characters, which it may not hold.
std::string quoted(const std::string &text)
{
	std::string result = "\"";
	for (const char letter : text) {
		const auto code = static_cast<unsigned char>(letter);
		if (code < ' ' || code == 0x7f)
			result += sentence("\\u%04x", code);
		else if (letter == '"' || letter == '\\')
			result += std::string("\\") + letter;
		else
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
			   "\nair_density = " + digits(rig.ball.air_density) +
			   "\nbounce = " + list(rig.ball.bounce, 3, 3) + "\n";
	for (const Coefficient &coefficient : coefficients)
		text += std::string(coefficient.key) + " = " + digits(rig.ball.*coefficient.value) + "\n";
	text += "spin_sigma = " + list(rig.ball.spin_sigma, 3, 3) + "\n";
	if (rig.table.present)
		text += "\n[table]\n";
	for (const Length &length : table_lengths)
		if (rig.table.present)
			text += std::string(length.key) + " = " + digits(rig.table.*length.value) + "\n";
	return text + "\n[hit]\nz = " + digits(rig.hit_z) + "\n" + write_camera(rig.camera[PONG_LEFT], "left") +
	       write_camera(rig.camera[PONG_RIGHT], "right");
}

} // namespace

} // namespace pong

void pong_rig_defaults(pong_rig *rig)
{
	*rig = {};
	rig->ball = pong::usual_ball();
	rig->table = pong::usual_table;
}

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

int pong_rig_load_flight(const char *path, pong_rig *rig, pong_error *error)
{
	return pong::guarded(error, [&] {
		*rig = pong::read_flight(pong::Document(pong::read_file(path), path));
		return PONG_FOUND;
	});
}

int pong_rig_format(const pong_rig *rig, char *text, int capacity)
{
	return snprintf(text, static_cast<size_t>(capacity), "%s", pong::write_rig(*rig).c_str());
}
