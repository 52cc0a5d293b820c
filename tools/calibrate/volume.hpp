// The number that counts: how far off a point over the table is expected to be, from the calibration alone.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "pongeye.h"
#include "session.hpp"

namespace calibrate
{

// A place, and the root mean square error that is expected there, mm; NaN where not both cameras see it.
struct ExpectedError {
	std::array<double, 3> position;
	double total, along[3]; // along x y z
};

struct Volume {
	std::vector<ExpectedError> places;
	double mean, worst; // of total over the places in view, mm; NaN where the calibration knows no covariance
	double seen;        // the part of the places that both cameras see
};

// A grid over the table, to half a metre above it.
std::vector<std::array<double, 3>> table_grid();

// That, or without a table one over the distances at which boards were shown.
std::vector<std::array<double, 3>> volume_grid(const Session &session, bool table);

Volume expect_error(const pong_calibration &calibration, const std::vector<std::array<double, 3>> &grid);

// A board in a pose that would help, and to what mean error it would bring the volume, mm.
struct Advice {
	std::string text;
	double mean;
};

// The best of a range of poses, best first.
std::vector<Advice> advise(const Session &session, const BoardSize &board,
			   const std::vector<std::array<double, 3>> &grid);

} // namespace calibrate
