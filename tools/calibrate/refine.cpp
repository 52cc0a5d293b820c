#include "refine.hpp"

#include <cmath>

#include "program.hpp"
#include "rig_file.hpp"
#include "table.hpp"

namespace calibrate
{

namespace
{

// What pongeye-track --output wrote: rows with both centres. A pause of more than a fifth of a second begins another
// flight.
std::vector<pong_sighting> read_sightings(const std::string &path)
{
	const pong::Table table(path);
	const size_t utime = table.column("utime"),
		     columns[2][2] = {{table.column("left_u"), table.column("left_v")},
				      {table.column("right_u"), table.column("right_v")}};
	std::vector<pong_sighting> sightings;
	int32_t flight = 1;
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
		if (!sightings.empty() && sighting.utime - sightings.back().utime > 200000)
			flight++;
		sighting.track = flight;
		sightings.push_back(sighting);
	}
	return sightings;
}

} // namespace

int refine(const Arguments &arguments)
{
	pong_rig rig;
	pong_error error;
	if (pong_rig_load(arguments.rig.c_str(), &rig, &error) < 0)
		throw pong::Failure(error.text);
	const auto sightings = read_sightings(arguments.refine);
	pong_refinement result;
	if (pong_refine(&rig, arguments.knocked, sightings.data(), static_cast<int>(sightings.size()), &result,
			&error) < 0)
		throw pong::Failure(arguments.refine + ": " + error.text);
	const double degrees = 180 / M_PI;
	fprintf(stderr,
		"%d sightings, %d flights, %d bounces\n"
		"epipolar distance: rms %.3f px before, %.3f px now\n"
		"the %s camera turned by %.4f %.4f %.4f degrees about its x y z (+- %.4f %.4f %.4f)\n",
		result.sightings, result.flights, result.bounces, result.epipolar_before, result.epipolar,
		arguments.knocked == PONG_LEFT ? "left" : "right", result.rotation[0] * degrees,
		result.rotation[1] * degrees, result.rotation[2] * degrees,
		std::sqrt(result.covariance[0][0]) * degrees, std::sqrt(result.covariance[1][1]) * degrees,
		std::sqrt(result.covariance[2][2]) * degrees);
	if (result.bounces)
		fprintf(stderr, "bounces: %.1f mm rms off the table before, %.1f mm now\n", 1e3 * result.bounce_before,
			1e3 * result.bounce);
	else
		pong::say("no bounce was seen: the rotation that moves depth is not corrected");
	write_rig(
		arguments.output, rig,
		pong::format("\n[calibration]\ndate = %s\nmethod = \"refined from flights\"\nsightings = %d\nbounces = "
			     "%d\nepipolar_rms_px = %.4f\n",
			     today().c_str(), result.sightings, result.bounces, result.epipolar));
	return 0;
}

} // namespace calibrate
