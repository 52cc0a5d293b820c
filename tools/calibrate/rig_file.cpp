#include "rig_file.hpp"

#include <cmath>
#include <cstdio>
#include <ctime>

#include "program.hpp"

namespace calibrate
{

pong_rig make_rig(const pong_camera camera[2], bool table)
{
	pong_rig rig;
	pong_rig_defaults(&rig);
	rig.table.present = table;
	rig.camera[PONG_LEFT] = camera[PONG_LEFT];
	rig.camera[PONG_RIGHT] = camera[PONG_RIGHT];
	return rig;
}

void write_rig(const std::string &path, const pong_rig &rig, const std::string &calibration)
{
	std::string text(static_cast<size_t>(pong_rig_format(&rig, nullptr, 0)) + 1, '\0');
	pong_rig_format(&rig, text.data(), static_cast<int>(text.size()));
	text.pop_back();
	write_text(path, text + calibration);
}

void write_text(const std::string &path, const std::string &text)
{
	FILE *file = path == "-" ? stdout : fopen(path.c_str(), "w");
	if (!file || fputs(text.c_str(), file) < 0 || fflush(file) != 0 || (file != stdout && fclose(file) != 0))
		throw pong::Failure(path + ": cannot be written");
}

std::string today()
{
	char text[32];
	const time_t now = time(nullptr);
	struct tm parts;
	strftime(text, sizeof text, "%Y-%m-%d", gmtime_r(&now, &parts));
	return text;
}

std::string describe_calibration(const Session &session, const Volume &volume, pong_profile profile)
{
	const pong_calibration &calibration = session.calibration;
	std::string text = pong::format("\n[calibration]\ndate = %s\nmethod = \"%s\"\npairs = %zu\nrms_px = %.4f\n"
					"sigma_px = %.4f # of a corner, per axis\n",
					today().c_str(), profile == PONG_PAPER ? "paper" : "best", session.used.size(),
					calibration.rms, calibration.sigma);
	if (!std::isfinite(volume.mean))
		return text;
	text += pong::format(
		"expected_error_mm = %.3f # root mean square, mean over the volume\n"
		"expected_error_worst_mm = %.3f\n"
		"# of fu fv cu cv (px) k1 k2 p1 p2 k3, rotation (rad), centre (m) of the left camera, then the "
		"right\ncovariance = [\n",
		volume.mean, volume.worst);
	for (const auto &row : calibration.covariance) {
		text += "    [";
		for (const double &value : row)
			text += pong::format("%s%.6g", &value == row ? "" : ", ", value);
		text += "],\n";
	}
	return text + "]\n";
}

} // namespace calibrate
