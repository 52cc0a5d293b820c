// The methods that fit a ball's centre, each in a file of its own.
#pragma once

#include "camera.hpp"

namespace pong
{

// What a fit looks at.
struct LocateTask {
	const pong_camera &camera;
	const pong_pictures &pictures;
	const pong_detection &detection;
	Vector2 streak; // how far the ball's picture moves during the exposure, px
	double sigma;   // the standard deviation of a centre where the method tells none, px
};

bool locate_gaussian(const LocateTask &task, pong_centre *centre);
bool locate_centroid(const LocateTask &task, pong_centre *centre);
bool locate_edges(const LocateTask &task, pong_centre *centre);
bool locate_photometric(const LocateTask &task, pong_centre *centre);

inline Matrix2 covariance_of(const pong_centre &centre)
{
	return Eigen::Map<const Matrix2>(&centre.covariance[0][0]);
}

} // namespace pong
