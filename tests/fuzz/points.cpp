// Any bytes into pongeye-predict's reader, and what it makes of them into a track.
#include <cstdint>
#include <sstream>

#include "predict/follow.hpp"
#include "predict/points.hpp"
#include "program.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	std::istringstream stream(std::string(reinterpret_cast<const char *>(data), size));
	pong_rig rig;
	pong_settings settings;
	pong_rig_defaults(&rig);
	pong_settings_defaults(PONG_BEST, &settings);
	try {
		predict::PointReader reader(stream, "fuzz");
		predict::Follower follower(rig, settings);
		predict::Row row;
		pong_prediction prediction;
		while (reader.next(&row)) {
			if (row.begins_flight)
				follower.begin();
			follower.push(row.point, 0);
			follower.predict(&prediction);
		}
	} catch (const pong::Failure &) {
		return 0; // one sentence: as it should be
	}
	return 0;
}
