// Rendered stereo pictures of one ball at a place, with what the simulator knows of it.
#pragma once

#include <array>
#include <vector>

#include "pongeye.h"
#include "simulate/renderer.hpp"

namespace bench
{

// A stereo pair of a ball, and two empty ones taken earlier.
struct Shot {
	int width, height;
	std::array<std::vector<uint8_t>, 3> pixels[2]; // by side: current, earlier, older
	Eigen::Vector3d position;                      // of the ball in the middle of the exposure, m
	double uv[2][2];                               // where the sphere's centre is seen, px

	pong_pictures pictures(pong_side side) const;
};

class Studio
{
public:
	Studio(const sim::Scene &scene, uint64_t seed);

	// A ball at a place, about, in the middle of the exposure. False where a camera does not see all of it.
	bool take(const Eigen::Vector3d &position, const Eigen::Vector3d &velocity, Shot *shot);

	const pong_rig &rig() const
	{
		return rig_;
	}

private:
	const sim::Scene scene_;
	const sim::Rig cameras_;
	sim::Renderer renderers_[2];
	pong_rig rig_;
	uint64_t frame_ = 0;
};

} // namespace bench
