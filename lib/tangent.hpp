// The plane across the ray to a ball: the pixels of a camera without distortion that looks along it. There the ball's
// outline is a circle, wherever in the picture it is.
#pragma once

#include "camera.hpp"

namespace pong
{

struct TangentPlane {
	TangentPlane(const Camera &camera, const Vector2 &pixel);

	Vector2 from_pixel(const Camera &camera, const Vector2 &pixel) const;
	Vector2 to_pixel(const Camera &camera, const Vector2 &place) const;

	Matrix3 frame; // rows: the axes of the plane, and the ray, in the camera's frame
	double focal;  // px
};

// from_pixel near a pixel, as a polynomial of the second order, exact at nine pixels: x and y are
// sum of at[j][i] s^i t^j, with s and t the distances from the middle over the reach.
struct PlaneMap {
	PlaneMap(const TangentPlane &plane, const Camera &camera, const Vector2 &middle, double reach);

	Vector2 operator()(const Vector2 &pixel) const;
	// The places of pixels begin .. begin + count - 1 of row v.
	void row(int v, int begin, int count, float *x, float *y) const;

	Vector2 middle;
	double reach;
	Vector2 at[3][3];
};

} // namespace pong
