// Any bytes into pongeye-predict's reader, and what it makes of them into tracks of both profiles: a prediction is
// finite.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <sstream>

#include "predict/follow.hpp"
#include "predict/points.hpp"
#include "program.hpp"

namespace
{

bool finite(const double values[3])
{
	return std::all_of(values, values + 3, [](double value) { return std::isfinite(value); });
}

void check(const pong_state &state)
{
	if (!finite(state.position) || !finite(state.velocity))
		abort();
}

void check(const pong_prediction &prediction)
{
	if (prediction.has_hit)
		check(prediction.hit);
	if (prediction.has_bounce)
		check(prediction.bounce);
	if (prediction.has_top)
		check(prediction.top);
	if (prediction.path_count < 0 || prediction.path_count > PONG_PATH_CAPACITY)
		abort();
	for (int i = 0; i < prediction.path_count; i++)
		if (!finite(prediction.path[i].position))
			abort();
	for (int i = 0; i < 4; i++)
		if (prediction.has_hit && prediction.hit_covariance[i][i] < 0) // NaN where unknown
			abort();
}

void follow(const std::string &text, pong_profile profile)
{
	std::istringstream stream(text);
	pong_rig rig;
	pong_settings settings;
	pong_rig_defaults(&rig);
	pong_settings_defaults(profile, &settings);
	predict::PointReader reader(stream, "fuzz");
	predict::Follower follower(rig, settings);
	predict::Row row;
	pong_prediction prediction;
	while (reader.next(&row)) {
		if (row.begins_flight)
			follower.begin();
		follower.push(row.point, 0);
		if (follower.predict(&prediction))
			check(prediction);
	}
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	const std::string text(reinterpret_cast<const char *>(data), size);
	try {
		follow(text, PONG_BEST);
		follow(text, PONG_PAPER);
	} catch (const pong::Failure &) {
		return 0; // one sentence: as it should be
	}
	return 0;
}
