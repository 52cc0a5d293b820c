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
	double time;                                   // s
	Eigen::Vector3d position, velocity;            // of the ball in the middle of the exposure, m, m/s
	double uv[2][2];                               // where the sphere's centre is seen, px

	pong_pictures pictures(pong_side side) const;
};

class Studio
{
public:
	Studio(const sim::Scene &scene, uint64_t seed);

	// A ball at a place, about, in the middle of the exposure. False where a camera does not see all of it.
	bool take(const Eigen::Vector3d &position, const Eigen::Vector3d &velocity, Shot *shot);

	// A ball that comes to about that place: up to `earlier` shots at so many frames a second, and last that one.
	// Shots in which a camera does not see all of the ball are left out; where the last would be, there is none.
	std::vector<Shot> follow(const Eigen::Vector3d &position, const Eigen::Vector3d &velocity, int earlier,
				 double rate);

	const pong_rig &rig() const
	{
		return rig_;
	}

private:
	// A flight that comes to the place after `lead` seconds, or a ball that rests there.
	sim::Episode make_episode(const Eigen::Vector3d &position, const Eigen::Vector3d &velocity, double lead) const;
	bool expose(const sim::Episode &episode, double time, Shot *shot);

	const sim::Scene scene_;
	const sim::Rig cameras_;
	sim::Renderer renderers_[2];
	pong_rig rig_;
	uint64_t frame_ = 0;
};

} // namespace bench
