// What is to be seen: all settings of the simulated world, read from TOML, and the built-in scenes.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "camera.hpp"
#include "room.hpp"
#include "sensor.hpp"
#include "serve.hpp"

namespace sim
{

// Light on the ball: albedo 1 under it has grey level
// level * (ambient + hemisphere * (1 + n.up) / 2 + diffuse * max(0, n.towards) + specular * lobe), n its normal.
struct Light {
	double level = 200; // grey levels
	double ambient = 0.38, hemisphere = 0.22, diffuse = 0.42, specular = 0;
	Eigen::Vector3d towards = Eigen::Vector3d(-0.2, 1, -0.6); // the lamp, table frame
	double logo = 0;                                          // how much darker the ball's printed spot is, 0 to 1
	double shadow = 0.3; // how much darker the table is under a ball that touches it, 0 to 1
};

struct PictureSettings {
	double exposure = 0.002; // s
	double blur = 0.6;       // standard deviation of the lens's point spread, px
	SensorSettings sensor;
};

struct BoardSettings {
	int columns = 9, rows = 6;                         // inner corners
	double square = 0.025;                             // m
	std::vector<double> planes = {0.5, 0.8, 1.1, 1.4}; // z of the upright poses, m
	double plane_y = NAN; // of the upright board's middle, m; NaN: where the cameras look
	int tilted = 15;      // poses in between
	// How wrongly the lying and the upright boards are placed, standard deviations: per axis, m; about each axis,
	// rad.
	double misplaced = 0, misturned = 0;
};

// What is shown, one after another.
enum class Show {
	flights,   // serves without end
	launches,  // the paper's 66: 11 directions x 3 speeds x 2
	positions, // the paper's 60 places of a resting ball
	board,     // a chessboard in many poses
};

struct Scene {
	Show show = Show::flights;
	RigSettings rig;
	double hit_z = 0; // m
	Light light;
	Background background;
	PictureSettings picture;
	FlightSettings flights;
	BoardSettings board;
	int people = 0; // that move behind the table
};

struct BuiltinScene {
	const char *name, *summary, *toml;
};

const std::vector<BuiltinScene> &builtin_scenes();

// A built-in scene by its name, else a scene file. Throws pong::Failure with file, line and column.
Scene load_scene(const std::string &name_or_path);

// A scene from text; `name` stands for the file in errors.
Scene parse_scene(const std::string &text, const std::string &name);

} // namespace sim
