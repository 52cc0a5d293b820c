// The ball in true perspective: which samples its outline holds, and how bright its surface is there.
#pragma once

#include <vector>

#include "ball.hpp"
#include "camera.hpp"
#include "scene.hpp"

namespace sim
{

// Samples of a part of a picture, row by row: ideal image points in, light in and out.
struct Samples {
	int columns = 0, rows = 0;
	std::vector<float> x, y;  // ideal image points
	std::vector<float> level; // of light, grey levels
	std::vector<float> depth; // of the first opaque surface, m
	std::vector<float> cover; // by the ball, 0 to 1, and
	std::vector<float> shine; // its light times that
};

// The ball's share of the exposure: draws `weight` of it into cover and shine of every `skip`-th row from `first` on.
struct Share {
	float weight;
	int first, skip;
};

void draw_sphere(const Camera &camera, const Light &light, const Ball &ball, const Share &share, Samples *samples);

// Points on the sphere's outline as the camera sees it, table frame: the circle where rays touch it.
std::vector<Eigen::Vector3d> sphere_outline(const Camera &camera, const Eigen::Vector3d &position, int count);

} // namespace sim
