// Owners of what the library's _new functions make.
#pragma once

#include <memory>

#include "pongeye.h"

namespace pong
{

template<auto free> struct Free {
	template<class Object> void operator()(Object *object) const
	{
		free(object);
	}
};

using OwnedEye = std::unique_ptr<pong_eye, Free<pong_eye_free>>;
using OwnedTrack = std::unique_ptr<pong_track, Free<pong_track_free>>;
using OwnedRegion = std::unique_ptr<pong_region, Free<pong_region_free>>;
using OwnedDetector = std::unique_ptr<pong_detector, Free<pong_detector_free>>;

} // namespace pong
