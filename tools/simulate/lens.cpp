#include "lens.hpp"

#include <algorithm>
#include <cmath>

namespace sim
{

namespace
{

// The point spread is a Gaussian: how much of the light of a sample `offset` px from a pixel's centre the pixel gets.
double share(double offset, double blur)
{
	if (blur == 0)
		return std::abs(offset) < 0.5;
	const double scale = 1 / (blur * std::sqrt(2.0));
	return (std::erf((offset + 0.5) * scale) - std::erf((offset - 0.5) * scale)) / 2;
}

} // namespace

bool Rect::empty() const
{
	return width <= 0 || height <= 0;
}

int Rect::right() const
{
	return u + width;
}

int Rect::bottom() const
{
	return v + height;
}

Rect intersection(const Rect &a, const Rect &b)
{
	const int u = std::max(a.u, b.u), v = std::max(a.v, b.v);
	return {u, v, std::max(0, std::min(a.right(), b.right()) - u),
		std::max(0, std::min(a.bottom(), b.bottom()) - v)};
}

Rect grown(const Rect &a, double u, double v)
{
	const auto pixel = [](double x) { return static_cast<int>(std::lround(std::clamp(x, -1e6, 1e6))); };
	if (a.empty())
		return {pixel(u), pixel(v), 1, 1};
	const int left = std::min(a.u, pixel(u)), top = std::min(a.v, pixel(v));
	return {left, top, std::max(a.right(), pixel(u) + 1) - left, std::max(a.bottom(), pixel(v) + 1) - top};
}

Rect with_margin(const Rect &a, int margin)
{
	return {a.u - margin, a.v - margin, a.width + 2 * margin, a.height + 2 * margin};
}

Lens::Lens(const Camera &camera, double blur)
	: camera_(camera), margin_(static_cast<int>(std::ceil(3.5 * blur))),
	  R_table_cam_(camera.R_cam_table.transpose())
{
	double sum = 0;
	for (int i = 0; i < (2 * margin_ + 1) * fine; i++) {
		weights_.push_back(static_cast<float>(share((i + 0.5) / fine - 0.5 - margin_, blur)));
		sum += weights_.back();
	}
	for (float &weight : weights_)
		weight = static_cast<float>(weight / sum);
	for (int v = -margin_; v <= camera.height + margin_; v++)
		for (int u = -margin_; u <= camera.width + margin_; u++) {
			const Eigen::Vector2d point = camera.ideal({u - 0.5, v - 0.5});
			corner_x_.push_back(static_cast<float>(point.x()));
			corner_y_.push_back(static_cast<float>(point.y()));
		}
}

const Camera &Lens::camera() const
{
	return camera_;
}

Rect Lens::picture() const
{
	return {0, 0, camera_.width, camera_.height};
}

int Lens::margin() const
{
	return margin_;
}

// Linear between the corners of each pixel: the distortion bends so little within one that 1e-6 px is not lost.
void Lens::ideal(const Rect &pixels, std::vector<float> *x, std::vector<float> *y) const
{
	x->clear();
	y->clear();
	const size_t stride = static_cast<size_t>(camera_.width + 2 * margin_ + 1);
	for (int j = 0; j < pixels.height * fine; j++) {
		const float t = (static_cast<float>(j % fine) + 0.5f) / fine;
		const size_t row = static_cast<size_t>(pixels.v + j / fine + margin_) * stride;
		for (int i = 0; i < pixels.width * fine; i++) {
			const float s = (static_cast<float>(i % fine) + 0.5f) / fine;
			const size_t at = row + static_cast<size_t>(pixels.u + i / fine + margin_);
			const auto blend = [&](const std::vector<float> &corner) {
				const float top = corner[at] + s * (corner[at + 1] - corner[at]);
				const float bottom =
					corner[at + stride] + s * (corner[at + stride + 1] - corner[at + stride]);
				return top + t * (bottom - top);
			};
			x->push_back(blend(corner_x_));
			y->push_back(blend(corner_y_));
		}
	}
}

Ray Lens::ray(float x, float y) const
{
	return {camera_.centre, R_table_cam_ * Eigen::Vector3d(x, y, 1)};
}

Ray Lens::pixel_ray(int u, int v) const
{
	const size_t stride = static_cast<size_t>(camera_.width + 2 * margin_ + 1);
	const size_t at = static_cast<size_t>(v + margin_) * stride + static_cast<size_t>(u + margin_);
	const auto middle = [&](const std::vector<float> &corner) {
		return (corner[at] + corner[at + 1] + corner[at + stride] + corner[at + stride + 1]) / 4;
	};
	return ray(middle(corner_x_), middle(corner_y_));
}

// The Gaussian and the pixel's square are both separable: rows first, then columns.
void Lens::integrate(const std::vector<float> &samples, const Rect &pixels, std::vector<float> *levels) const
{
	const int columns = pixels.width, rows = (pixels.height + 2 * margin_) * fine;
	const size_t stride = static_cast<size_t>(columns + 2 * margin_) * fine;
	const int taps = static_cast<int>(weights_.size());
	std::vector<float> narrow(static_cast<size_t>(rows) * static_cast<size_t>(columns), 0.0f);
	for (int row = 0; row < rows; row++)
		for (int u = 0; u < columns; u++) {
			const float *from = &samples[static_cast<size_t>(row) * stride + static_cast<size_t>(u * fine)];
			float sum = 0;
			for (int i = 0; i < taps; i++)
				sum += weights_[static_cast<size_t>(i)] * from[i];
			narrow[static_cast<size_t>(row * columns + u)] = sum;
		}
	levels->assign(static_cast<size_t>(columns) * static_cast<size_t>(pixels.height), 0.0f);
	for (int v = 0; v < pixels.height; v++) {
		float *to = &(*levels)[static_cast<size_t>(v * columns)];
		for (int i = 0; i < taps; i++) {
			const float *from = &narrow[static_cast<size_t>((v * fine + i) * columns)];
			for (int u = 0; u < columns; u++)
				to[u] += weights_[static_cast<size_t>(i)] * from[u];
		}
	}
}

} // namespace sim
