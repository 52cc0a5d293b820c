#include "refine.hpp"

#include <algorithm>
#include <cmath>

#include "program.hpp"
#include "rig_edit.hpp"
#include "rig_file.hpp"
#include "table.hpp"
#include "volume.hpp"

namespace calibrate
{

namespace
{

// Appends what pongeye-track --output wrote: rows with both centres. A pause of more than a fifth of a second begins
// another flight.
void add_sightings(const std::string &path, std::vector<pong_sighting> &sightings)
{
	const pong::Table table(path);
	const size_t utime = table.column("utime"),
		     columns[2][2] = {{table.column("left_u"), table.column("left_v")},
				      {table.column("right_u"), table.column("right_v")}};
	int32_t flight = sightings.empty() ? 1 : sightings.back().track + 1;
	bool begun = false;
	for (size_t row = 0; row < table.rows(); row++) {
		pong_sighting sighting = {};
		bool seen = true;
		for (int side = 0; side < 2; side++)
			for (int axis = 0; axis < 2; axis++) {
				sighting.uv[side][axis] = table.get(row, columns[side][axis]);
				seen = seen && std::isfinite(sighting.uv[side][axis]);
			}
		if (!seen)
			continue;
		sighting.utime = table.get_integer(row, utime);
		if (begun && sighting.utime - sightings.back().utime > 200000)
			flight++;
		begun = true;
		sighting.track = flight;
		sightings.push_back(sighting);
	}
}

// Tables only: pongeye-track makes one of a recording.
std::vector<pong_sighting> read_sightings(const std::vector<std::string> &paths)
{
	std::vector<pong_sighting> sightings;
	for (const std::string &path : paths) {
		if (path.size() > 4 && path.substr(path.size() - 4) == ".lcm")
			throw pong::Failure(path + ": a recording; pongeye-track --replay " + path +
					    " --output FILE makes a table of it");
		add_sightings(path, sightings);
	}
	return sightings;
}

const char *name_of(pong_side side)
{
	return side == PONG_LEFT ? "left" : "right";
}

// How far points over the table are expected to be off from what is not known of the rotation, mm.
double expected_error(const pong_rig &rig, pong_side side, const pong_refinement &result)
{
	pong_calibration calibration = {};
	std::copy_n(rig.camera, 2, calibration.camera);
	const int first = side * PONG_CAMERA_NUMBERS + 9; // the rotation's place among them
	for (int row = 0; row < 3; row++)
		std::copy_n(result.covariance[row], 3, &calibration.covariance[first + row][first]);
	return expect_error(calibration, table_grid()).mean;
}

void tell(const pong_rig &rig, pong_side side, const pong_refinement &result)
{
	const double degrees = 180 / M_PI;
	fprintf(stderr,
		"%d sightings, %d flights, %d bounces\n"
		"epipolar distance: rms %.3f px before, %.3f px now\n"
		"the %s camera turned by %.4f %.4f %.4f degrees about its x y z (+- %.4f %.4f %.4f)\n",
		result.sightings, result.flights, result.bounces, result.epipolar_before, result.epipolar,
		name_of(side), result.rotation[0] * degrees, result.rotation[1] * degrees, result.rotation[2] * degrees,
		std::sqrt(result.covariance[0][0]) * degrees, std::sqrt(result.covariance[1][1]) * degrees,
		std::sqrt(result.covariance[2][2]) * degrees);
	if (result.bounces)
		fprintf(stderr, "bounces: %.1f mm rms off the table before, %.1f mm now\n", 1e3 * result.bounce_before,
			1e3 * result.bounce);
	else
		pong::say("no bounce was seen: the rotation that moves depth is not corrected");
	if (rig.table.present)
		fprintf(stderr, "expected 3-D error from that rotation %.2f mm in the mean over the table\n",
			expected_error(rig, side, result));
}

std::string describe(pong_side side, const pong_refinement &result)
{
	const auto numbers = [](const double values[3]) {
		return pong::format("[%.6g, %.6g, %.6g]", values[0], values[1], values[2]);
	};
	return pong::format("[refinement] # since the calibration: one camera's direction, from flights\n"
			    "date = %s\nknocked = \"%s\"\nsightings = %d\nflights = %d\nbounces = %d\n"
			    "epipolar_rms_px = %.4f\n"
			    "rotation = %s # about the camera's own x y z, rad\n"
			    "covariance = [\n    %s,\n    %s,\n    %s]\n",
			    today().c_str(), name_of(side), result.sightings, result.flights, result.bounces,
			    result.epipolar, numbers(result.rotation).c_str(), numbers(result.covariance[0]).c_str(),
			    numbers(result.covariance[1]).c_str(), numbers(result.covariance[2]).c_str());
}

} // namespace

int refine(const Arguments &arguments)
{
	pong_rig rig;
	pong_error error;
	if (pong_rig_load(arguments.rig.c_str(), &rig, &error) < 0)
		throw pong::Failure(error.text);
	const auto sightings = read_sightings(arguments.refine);
	const pong_side side = arguments.knocked;
	pong_refinement result;
	if (pong_refine(&rig, side, sightings.data(), static_cast<int>(sightings.size()), &result, &error) < 0)
		throw pong::Failure(arguments.refine.front() + ": " + error.text);
	tell(rig, side, result);
	const std::string corrected = with_camera(read_text(arguments.rig), arguments.rig, side, rig.camera[side]);
	write_text(arguments.output, with_section(corrected, arguments.rig, "refinement", describe(side, result)));
	return 0;
}

} // namespace calibrate
