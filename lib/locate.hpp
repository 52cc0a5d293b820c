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
	double growth;  // of its size meanwhile, over its size
	double sigma;   // the standard deviation of a centre where the method tells none, px
};

bool locate_gaussian(const LocateTask &task, pong_centre *centre);
bool locate_centroid(const LocateTask &task, pong_centre *centre);
bool locate_edges(const LocateTask &task, pong_centre *centre);
bool locate_photometric(const LocateTask &task, pong_centre *centre);

// How much of the error of a centre the other camera's centre of the same ball has too: both see the same light on it
// (measured, docs/locate.md).
const double common_part = 0.5;

inline pong_centre make_centre(const Vector2 &uv, double radius, const Matrix2 &covariance)
{
	pong_centre centre = {};
	centre.u = uv.x();
	centre.v = uv.y();
	centre.radius = radius;
	Eigen::Map<Matrix2>{&centre.covariance[0][0]} = covariance;
	return centre;
}

inline Matrix2 covariance_of(const pong_centre &centre)
{
	return Eigen::Map<const Matrix2>(&centre.covariance[0][0]);
}

} // namespace pong
