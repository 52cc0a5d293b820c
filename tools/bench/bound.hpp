// How well a ball's position could be told from one stereo pair at all.
#pragma once

#include "studio.hpp"

namespace bench
{

// The Cramer-Rao bound as the mean distance from the truth, m: of an unbiased method that knows the light, the lens,
// the background, the ball's size and its velocity, and only not where it is. From the derivatives of noise-free
// pictures by the position and the noise of the scene's sensor; `still` is a studio of that scene whose sensor has
// none. NaN where a camera does not see all of the ball.
double position_bound(const sim::Scene &scene, Studio &still, const Eigen::Vector3d &position,
		      const Eigen::Vector3d &velocity);

} // namespace bench
