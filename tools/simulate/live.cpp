#include "live.hpp"

#include <algorithm>
#include <cmath>

namespace sim
{

// A board rests for a second in each pose, so that people can follow.
LiveWorld::LiveWorld(const Scene &scene, uint64_t seed, double rate, const std::string &truth_path)
	: rate_(rate), rig_(make_rig(scene.rig)),
	  world_(scene, rig_, seed, rate, std::max(1, static_cast<int>(std::lround(rate))))
{
	for (int side = 0; side < 2; side++)
		renderers_[side] = std::make_unique<Renderer>(scene, rig_[side], seed, side);
	if (!truth_path.empty())
		truth_ = std::make_unique<Truth>(truth_path, rig_);
}

double LiveWorld::time_of(int64_t pulse) const
{
	return static_cast<double>(pulse - 1) / rate_;
}

void LiveWorld::render(int camera, int64_t pulse, double exposure, uint8_t *pixels)
{
	const double time = time_of(pulse);
	renderers_[camera]->render(world_.at(time).get(), {time, exposure, static_cast<uint64_t>(pulse)}, pixels);
}

void LiveWorld::exposed(int64_t pulse, int64_t utime)
{
	const double time = time_of(pulse);
	if (truth_)
		truth_->add(utime, pulse, world_.at(time).get(), time);
}

} // namespace sim
