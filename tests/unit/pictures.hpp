// Pictures for the unit tests: a noisy background and round balls, drawn without the library's help.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "pongeye.h"

class Picture
{
public:
	Picture(int width, int height, uint8_t background);

	// A disc with smooth edges: each pixel by how much of it is covered, 8 x 8 samples.
	void draw_ball(double u, double v, double radius, double brightness);
	// Gaussian, grey levels.
	void add_noise(double sigma, unsigned seed);

	pong_image image() const
	{
		return {pixels_.data(), width_, height_, width_};
	}

private:
	int width_, height_;
	std::vector<uint8_t> pixels_;
};
