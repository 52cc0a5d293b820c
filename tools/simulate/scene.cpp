#include "scene.hpp"

#include <fstream>
#include <sstream>

#include "program.hpp"
#include "section.hpp"

namespace sim
{

namespace
{

const std::vector<std::string> shows = {"flights", "launches", "positions", "board"};
const std::vector<std::string> lights = {"overhead", "front", "diffuse", "logo", "specular"};

// The lights that detectors are measured under.
Light named_light(int number)
{
	Light light;
	const std::string &name = lights[static_cast<size_t>(number)];
	if (name == "front")
		light.towards = {0.1, 0.3, -1};
	if (name == "diffuse") {
		light.ambient = 0.65;
		light.hemisphere = 0.35;
		light.diffuse = 0;
	}
	if (name == "logo")
		light.logo = 0.6;
	if (name == "specular")
		light.specular = 0.5;
	return light;
}

void read_rig(Section section, RigSettings *rig)
{
	section.integer("width", &rig->width, 64, 8192);
	section.integer("height", &rig->height, 64, 8192);
	section.number("focal", &rig->focal, 10, 1e5);
	section.number("baseline", &rig->baseline, 0.001, 10);
	section.number("behind", &rig->behind, 0, 10);
	section.number("above", &rig->above, 0.05, 10);
	section.number("pitch", &rig->pitch, -45, 80);
	section.numbers("distortion", rig->distortion.data(), 5, -10, 10);
	section.finish();
}

void read_light(Section section, Light *light)
{
	int kind = -1;
	section.choice("kind", lights, &kind);
	if (kind >= 0)
		*light = named_light(kind);
	section.number("level", &light->level, 0, 1000);
	section.number("ambient", &light->ambient, 0, 2);
	section.number("hemisphere", &light->hemisphere, 0, 2);
	section.number("diffuse", &light->diffuse, 0, 2);
	section.number("specular", &light->specular, 0, 2);
	section.number("logo", &light->logo, 0, 1);
	section.number("shadow", &light->shadow, 0, 1);
	section.numbers("towards", light->towards.data(), 3, -1000, 1000);
	if (light->towards.norm() == 0)
		section.fail("towards", "needs a direction, not 0, 0, 0");
	section.finish();
}

void read_background(Section section, Background *background)
{
	section.number("level", &background->level, 0, 255);
	section.number("contrast", &background->contrast, 0, 128);
	section.number("distance", &background->distance, 3, 50);
	section.finish();
}

void read_picture(Section section, PictureSettings *picture)
{
	section.number("exposure", &picture->exposure, 0, 0.1);
	section.number("blur", &picture->blur, 0, 5);
	section.flag("noise", &picture->sensor.noise);
	section.number("full_well", &picture->sensor.full_well, 1000, 1e6);
	section.number("read_noise", &picture->sensor.read_noise, 0, 100);
	section.finish();
}

void read_interval(Section &section, const char *key, std::array<double, 2> *interval, double min, double max)
{
	section.numbers(key, interval->data(), 2, min, max);
	if ((*interval)[0] > (*interval)[1])
		section.fail(key, "needs the smaller number first");
}

void read_flights(Section section, FlightSettings *flights)
{
	read_interval(section, "speed", &flights->speed, 1, 30);
	read_interval(section, "aim", &flights->aim, -2, 2);
	read_interval(section, "bounce", &flights->bounce, 0, table_length / 2);
	section.number("spin", &flights->spin, 0, 200);
	section.number("gap", &flights->gap, 0, 60);
	section.numbers("drag", flights->drag.data(), 2, 0, 2);
	section.numbers("magnus", flights->magnus.data(), 2, 0, 1e-4);
	section.numbers("restitution", flights->restitution.data(), 2, 0, 1);
	section.numbers("friction", flights->friction.data(), 2, 0, 2);
	section.finish();
}

void read_board(Section section, BoardSettings *board)
{
	section.integer("columns", &board->columns, 2, 50);
	section.integer("rows", &board->rows, 2, 50);
	section.number("square", &board->square, 0.001, 1);
	section.list("planes", &board->planes, -10, 50);
	section.number("plane_y", &board->plane_y, -1, 3);
	section.integer("tilted", &board->tilted, 0, 1000);
	section.number("misplaced", &board->misplaced, 0, 0.1);
	section.number("misturned", &board->misturned, 0, 0.5);
	section.finish();
}

// Only built-in scenes can be built upon: no file can then include itself.
Scene builtin_scene(const Section &section, const std::string &name)
{
	for (const BuiltinScene &scene : builtin_scenes())
		if (name == scene.name)
			return parse_scene(scene.toml, scene.name);
	section.fail("base", "names no built-in scene: '" + name + "'");
}

Scene read_scene(const toml::table &table, const std::string &name)
{
	Section section(&table, name);
	Scene scene;
	std::string base;
	section.text("base", &base);
	if (!base.empty())
		scene = builtin_scene(section, base);
	int show = static_cast<int>(scene.show);
	section.choice("show", shows, &show);
	scene.show = static_cast<Show>(show);
	section.number("hit_z", &scene.hit_z, -1, table_length);
	section.integer("people", &scene.people, 0, 2);
	read_rig(section.section("rig"), &scene.rig);
	read_light(section.section("light"), &scene.light);
	read_background(section.section("background"), &scene.background);
	read_picture(section.section("picture"), &scene.picture);
	read_flights(section.section("flights"), &scene.flights);
	read_board(section.section("board"), &scene.board);
	section.finish();
	return scene;
}

} // namespace

const std::vector<BuiltinScene> &builtin_scenes()
{
	static const std::vector<BuiltinScene> scenes = {
		{"rally", "serves to the robot one after another, light spin", "show = 'flights'"},
		{"paper60", "the paper's 60 static positions, 20 over the table at three heights",
		 "show = 'positions'"},
		{"paper66", "the paper's 66 launches, 11 directions x 3 speeds x 2, light spin", "show = 'launches'"},
		{"whitewall", "a white ball before a bright wall in strong light",
		 "[light]\nlevel = 235\n[background]\nlevel = 195\ncontrast = 10"},
		{"people", "serves, while two people move behind the table", "people = 2"},
		{"board", "a chessboard in many poses, for calibration", "show = 'board'"},
	};
	return scenes;
}

Scene load_scene(const std::string &name_or_path)
{
	for (const BuiltinScene &scene : builtin_scenes())
		if (name_or_path == scene.name)
			return parse_scene(scene.toml, scene.name);
	std::ifstream file(name_or_path);
	std::ostringstream text;
	if (!file || !(text << file.rdbuf()))
		throw pong::Failure(name_or_path + " is neither a built-in scene nor a file that can be read");
	return parse_scene(text.str(), name_or_path);
}

Scene parse_scene(const std::string &text, const std::string &name)
{
	try {
		return read_scene(toml::parse(text, name), name);
	} catch (const toml::parse_error &error) {
		const toml::source_position &place = error.source().begin;
		throw pong::Failure(pong::format("%s:%u:%u: %s", name.c_str(), static_cast<unsigned>(place.line),
						 static_cast<unsigned>(place.column),
						 std::string(error.description()).c_str()));
	}
}

} // namespace sim
