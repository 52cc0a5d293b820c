// From points of the picture to rays, and from fine samples to pixels: the lens's distortion and its blur.
//
// Everything is drawn on samples, `Lens::fine` by `fine` of them a pixel, and then blurred and integrated to pixels.
#pragma once

#include <vector>

#include "camera.hpp"
#include "room.hpp"

namespace sim
{

// A rectangle of pixels: columns u .. u + width - 1, rows v .. v + height - 1.
struct Rect {
	int u, v, width, height;

	bool empty() const;
	int right() const;
	int bottom() const;
};

Rect intersection(const Rect &a, const Rect &b);
// The smallest one that holds all of a and the pixel around (u, v).
Rect grown(const Rect &a, double u, double v);
Rect with_margin(const Rect &a, int margin);

class Lens
{
public:
	static constexpr int fine = 3; // samples per pixel, along u and along v

	// `blur` is the standard deviation of the point spread, px.
	Lens(const Camera &camera, double blur);

	const Camera &camera() const;
	Rect picture() const;
	// How far outside of a pixel the blur reaches, px.
	int margin() const;

	// The ideal image points of all samples of `pixels`, row by row; within margin() of the picture.
	void ideal(const Rect &pixels, std::vector<float> *x, std::vector<float> *y) const;

	// Ray of a sample, in the table frame; t along it is the depth.
	Ray ray(float x, float y) const;
	// Ray of a pixel's centre.
	Ray pixel_ray(int u, int v) const;

	// Blur and integrate samples, which cover `pixels` and margin() around them, to those pixels.
	void integrate(const std::vector<float> &samples, const Rect &pixels, std::vector<float> *levels) const;

private:
	Camera camera_;
	int margin_;
	std::vector<float> weights_;             // of the samples from margin_ before a pixel to margin_ behind it
	std::vector<float> corner_x_, corner_y_; // ideal points of the pixels' corners
	Eigen::Matrix3d R_table_cam_;
};

} // namespace sim
