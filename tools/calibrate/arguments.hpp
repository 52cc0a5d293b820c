// What the command line asks for.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "corners.hpp"
#include "pongeye.h"

namespace calibrate
{

struct Arguments {
	BoardSize board = {};
	std::vector<std::string> files[2]; // by pong_side
	int profile = PONG_BEST;
	std::vector<double> plane_z;   // of the first pictures, m
	double plane_at[2] = {0, 0.3}; // x and y of the board's middle on the planes, m
	double plane_sigma[2] = {0.0005, 0.002};
	std::string flat;                // the picture of the board that lies on the table
	double flat_at[3] = {0, 0.6, 0}; // x and z of its middle, its thickness, m
	double flat_sigma[2] = {0.001, 0.002};
	std::string table_pair;       // the pictures in which the table's corners are found
	std::vector<double> table[2]; // pixels of the table's corners, NaN where not seen; with table_pair: roughly
	double table_sigma = 0;       // m; 0: the corners' distances are free
	bool no_table = false;        // the frame is the left camera's
	std::string check, cameras, rig;
	std::vector<std::string> refine; // tables of flights
	int pairs = 24;                  // to be collected live
	std::string save;                // the folder for their pictures
	pong_side knocked = PONG_RIGHT;
	std::string output = "rig.toml", report;
	double accept = 0; // mm; 0: 5 over a table, without one anything
	bool force = false;
};

// Throws pong::UsageError. False where --help or --version has been answered.
bool parse_arguments(int argc, char **argv, Arguments &arguments);

} // namespace calibrate
