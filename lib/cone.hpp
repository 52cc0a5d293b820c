// The cone of rays that touch a sphere: what the outline of a ball in a picture is, whatever the lens.
#pragma once

#include "camera.hpp"

namespace pong
{

// A point of the outline, and how much it tells.
struct EdgePoint {
	Vector2 pixel;
	double deviation; // standard deviation across the outline, px; infinite where the point is not used
};

// What the cone says of the ball's picture.
struct ConeFit {
	Vector2 centre;     // where the sphere's centre is seen, px: not the middle of its outline
	double radius;      // of the outline, px
	Matrix2 covariance; // of the centre, px^2
	double residual;    // root mean square distance of the points used to the cone, in their deviations
	int used;           // points that agree with the cone
};

const int edge_points_max = 96;

// Fit the cone to count <= edge_points_max points, but to those that lie far off; their deviation becomes infinite.
// Returns false where too few agree.
bool fit_cone(const Camera &camera, EdgePoint *points, int count, ConeFit *fit);

} // namespace pong
