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
	// Whatever else has one brightness: columns and rows [begin, end).
	void draw_box(int u_begin, int u_end, int v_begin, int v_end, uint8_t brightness);
	// A net that stands in these rows: dark strings every few pixels, and a white band along its top.
	void draw_net(int v_begin, int v_end);
	// In light of so many times the strength.
	void brighten(double gain);
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
