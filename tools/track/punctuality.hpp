// Whether pictures come when their times say.
//
// From the exposure's end to a picture's first packet a camera always takes the same time: it reads out its sensor. A
// picture that seems to take much longer or shorter was held up by a busy host, or its camera's clock was set since
// it was last compared. A clock that is set back by just one period shows in no other way.
#pragma once

#include <cstdint>
#include <cstdlib>

namespace track
{

class Punctuality
{
public:
	// delay: from the exposure, by the picture's time, to its first packet, ns.
	bool doubts(int64_t delay) const
	{
		return known_ && std::abs(delay - usual_) > LIMIT;
	}

	// The least is what the camera takes; what comes on top is the host's. It may grow slowly.
	void learn(int64_t delay)
	{
		usual_ = !known_ || delay < usual_ ? delay : usual_ + (delay - usual_) / SLOWNESS;
		known_ = true;
	}

private:
	static constexpr int64_t LIMIT = 1000000; // ns: as far as a ball flies in that is 1 cm
	static constexpr int64_t SLOWNESS = 64;   // pictures

	bool known_ = false;
	int64_t usual_ = 0; // ns
};

} // namespace track
