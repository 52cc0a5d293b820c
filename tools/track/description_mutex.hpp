// Aravis parses cameras' descriptions (GenICam) in one thread at a time only.
#pragma once

#include <mutex>

namespace track
{

// To be held while a description is parsed.
inline std::mutex &description_mutex()
{
	static std::mutex mutex;
	return mutex;
}

} // namespace track
