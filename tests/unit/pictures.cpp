#include "pictures.hpp"

#include <algorithm>
#include <cmath>

Picture::Picture(int width, int height, uint8_t background)
	: width_(width), height_(height), pixels_(static_cast<size_t>(width) * height, background)
{
	for (int v = 0; v < height; v++)
		for (int u = 0; u < width; u++)
			pixels_[static_cast<size_t>(v) * width + u] += static_cast<uint8_t>((u / 16 + v / 16) % 2 * 10);
}

void Picture::draw_ball(double u0, double v0, double radius, double brightness)
{
	const int reach = static_cast<int>(std::ceil(radius)) + 1;
	const int u_mid = static_cast<int>(std::lround(u0)), v_mid = static_cast<int>(std::lround(v0));
	for (int v = std::max(0, v_mid - reach); v <= std::min(height_ - 1, v_mid + reach); v++)
		for (int u = std::max(0, u_mid - reach); u <= std::min(width_ - 1, u_mid + reach); u++) {
			int covered = 0;
			for (int sample = 0; sample < 64; sample++) {
				const double du = u + (sample % 8 - 3.5) / 8 - u0, dv = v + (sample / 8 - 3.5) / 8 - v0;
				covered += du * du + dv * dv < radius * radius;
			}
			uint8_t &pixel = pixels_[static_cast<size_t>(v) * width_ + u];
			pixel = static_cast<uint8_t>(std::lround(pixel + (brightness - pixel) * covered / 64.0));
		}
}

void Picture::draw_box(int u_begin, int u_end, int v_begin, int v_end, uint8_t brightness)
{
	for (int v = std::max(0, v_begin); v < std::min(height_, v_end); v++)
		for (int u = std::max(0, u_begin); u < std::min(width_, u_end); u++)
			pixels_[static_cast<size_t>(v) * width_ + u] = brightness;
}

void Picture::draw_net(int v_begin, int v_end)
{
	const int mesh = 6, band = 8; // px
	const uint8_t strings = 15, white = 220;
	for (int v = v_begin; v < v_end; v += mesh)
		draw_box(0, width_, v, v + 2, strings);
	for (int u = 0; u < width_; u += mesh)
		draw_box(u, u + 2, v_begin, v_end, strings);
	draw_box(0, width_, v_begin, v_begin + band, white);
}

void Picture::brighten(double gain)
{
	for (uint8_t &pixel : pixels_)
		pixel = static_cast<uint8_t>(std::min(255.0, gain * pixel + 0.5));
}

// Deviates are drawn once and used from a random place on in each row: quick, and different in every picture.
void Picture::add_noise(double sigma, unsigned seed)
{
	static const std::vector<double> deviates = [] {
		std::mt19937 generator(1);
		std::normal_distribution<double> normal;
		std::vector<double> drawn(1 << 16);
		for (double &deviate : drawn)
			deviate = normal(generator);
		return drawn;
	}();
	std::mt19937 generator(seed);
	for (int v = 0; v < height_; v++) {
		const size_t start = generator();
		for (int u = 0; u < width_; u++) {
			uint8_t &pixel = pixels_[static_cast<size_t>(v) * width_ + u];
			const double noise = deviates[(start + static_cast<size_t>(u)) % deviates.size()];
			pixel = static_cast<uint8_t>(std::clamp(std::floor(pixel + sigma * noise + 0.5), 0.0, 255.0));
		}
	}
}
