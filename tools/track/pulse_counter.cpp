#include "pulse_counter.hpp"

#include "description_mutex.hpp"

namespace track
{

namespace
{

bool has(ArvCamera *camera, const char *feature)
{
	return arv_camera_is_feature_available(camera, feature, nullptr);
}

// A camera with one counter has it count the trigger's line anyway; one with several is told to.
bool count_line(ArvCamera *camera, const std::string &line, bool falling_edge)
{
	if (!has(camera, "CounterSelector"))
		return true;
	const char *const first =
		arv_camera_is_enumeration_entry_available(camera, "CounterSelector", "Counter0", nullptr) ? "Counter0"
													  : "Counter1";
	GError *error = nullptr;
	arv_camera_set_string(camera, "CounterSelector", first, &error);
	if (!error)
		arv_camera_set_string(camera, "CounterEventSource", line.c_str(), &error);
	if (!error && has(camera, "CounterEventActivation"))
		arv_camera_set_string(camera, "CounterEventActivation", falling_edge ? "FallingEdge" : "RisingEdge",
				      &error);
	const bool counts = !error;
	g_clear_error(&error);
	return counts;
}

bool send_count(ArvCamera *camera)
{
	GError *error = nullptr;
	arv_camera_set_chunk_mode(camera, TRUE, &error);
	if (!error && has(camera, "ChunkSelector"))
		arv_camera_set_chunk_state(camera, "CounterValue", TRUE, &error);
	const bool sends = !error;
	g_clear_error(&error);
	if (!sends)
		arv_camera_set_chunk_mode(camera, FALSE, nullptr);
	return sends;
}

} // namespace

void PulseCounter::open(ArvCamera *camera, const std::string &line, bool falling_edge)
{
	if (!has(camera, "ChunkModeActive") || !has(camera, "ChunkCounterValue") ||
	    !count_line(camera, line, falling_edge) || !send_count(camera))
		return;
	const std::lock_guard<std::mutex> lock(description_mutex());
	parser_.reset(arv_camera_create_chunk_parser(camera));
}

std::optional<int64_t> PulseCounter::read(ArvBuffer *picture) const
{
	if (!parser_ || !arv_buffer_has_chunks(picture))
		return std::nullopt;
	GError *error = nullptr;
	const int64_t count = arv_chunk_parser_get_integer_value(parser_.get(), picture, "ChunkCounterValue", &error);
	const bool failed = error != nullptr;
	g_clear_error(&error);
	return failed ? std::nullopt : std::optional<int64_t>(count);
}

} // namespace track
