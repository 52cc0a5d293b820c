// A camera's own count of the trigger's pulses, which it sends behind the pixels of each picture (SFNC: chunk data).
#pragma once

#include <arv.h>
#include <cstdint>
#include <optional>
#include <string>

#include "object.hpp"

namespace track
{

class PulseCounter
{
public:
	// Switch it on where the camera has one: before the stream is opened, for pictures get longer by it. `line` is
	// the trigger's input.
	void open(ArvCamera *camera, const std::string &line, bool falling_edge);

	// Pulses up to a picture's own; none where the camera does not count.
	std::optional<int64_t> read(ArvBuffer *picture) const;

private:
	Object<ArvChunkParser> parser_;
};

} // namespace track
