// Any bytes as rig.toml: the rig, the settings, and what the cameras are told. What reads as a rig must be written and
// read again to the same, and a camera or a section in it can be changed in place, or is refused.
#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "bytes_file.hpp"
#include "calibrate/rig_edit.hpp"
#include "pongeye.h"
#include "program.hpp"
#include "track/capture_settings.hpp"

namespace
{

std::string written(const pong_rig &rig)
{
	std::vector<char> text(static_cast<size_t>(pong_rig_format(&rig, nullptr, 0)) + 1);
	pong_rig_format(&rig, text.data(), static_cast<int>(text.size()));
	return text.data();
}

pong_rig read(const std::string &text)
{
	pong_rig rig;
	pong_error error;
	if (pong_rig_parse(text.c_str(), "again", &rig, &error) < 0)
		abort();
	return rig;
}

void check_round_trip(const pong_rig &rig)
{
	const std::string text = written(rig);
	if (written(read(text)) != text)
		abort();
}

// Nothing but the camera's P is changed.
void check_edit(const std::string &text, const pong_rig &rig)
{
	pong_camera camera = rig.camera[PONG_RIGHT];
	camera.P[0][3] += 1;
	try {
		pong_rig edited = read(calibrate::with_camera(text, "fuzz", PONG_RIGHT, camera));
		std::copy_n(&rig.camera[PONG_RIGHT].P[0][0], 12, &edited.camera[PONG_RIGHT].P[0][0]);
		if (written(edited) != written(rig))
			abort();
	} catch (const pong::Failure &) {
		return; // one sentence: as it should be
	}
}

// Nothing but the section is changed.
void check_section(const std::string &text, const pong_rig &rig)
{
	try {
		if (written(read(calibrate::with_section(text, "fuzz", "note", "[note]\na = 1\n"))) != written(rig))
			abort();
	} catch (const pong::Failure &) {
		return; // one sentence: as it should be
	}
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	const std::string bytes(reinterpret_cast<const char *>(data), size), text = bytes.c_str();
	pong_rig rig;
	pong_settings settings;
	pong_error error;
	if (pong_rig_parse(text.c_str(), "fuzz", &rig, &error) > 0) {
		check_round_trip(rig);
		check_edit(text, rig);
		check_section(text, rig);
	}
	pong_settings_defaults(PONG_BEST, &settings);
	pong_settings_parse(text.c_str(), "fuzz", &settings, &error);
	const BytesFile file(data, size);
	pong_rig_load_flight(file.path().c_str(), &rig, &error);
	try {
		track::load_capture_settings(file.path());
	} catch (const pong::Failure &) {
		return 0; // one sentence: as it should be
	}
	return 0;
}
