// Any bytes as rig.toml: the rig, the settings, and what the cameras are told. What reads as a rig must be written and
// read again to the same.
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "bytes_file.hpp"
#include "pongeye.h"
#include "program.hpp"
#include "track/capture_settings.hpp"

namespace
{

void check_round_trip(const pong_rig &rig)
{
	const int size = pong_rig_format(&rig, nullptr, 0);
	std::vector<char> text(static_cast<size_t>(size) + 1);
	pong_rig_format(&rig, text.data(), size + 1);
	pong_rig again;
	pong_error error;
	if (pong_rig_parse(text.data(), "again", &again, &error) < 0)
		abort();
	std::vector<char> text_again(static_cast<size_t>(size) + 1);
	if (pong_rig_format(&again, text_again.data(), size + 1) != size || text != text_again)
		abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	const std::string text(reinterpret_cast<const char *>(data), size);
	pong_rig rig;
	pong_settings settings;
	pong_error error;
	if (pong_rig_parse(text.c_str(), "fuzz", &rig, &error) > 0)
		check_round_trip(rig);
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
