#include "backdrop.hpp"

#include <cmath>

#include "people.hpp"

namespace sim
{

namespace
{

constexpr int fine = Lens::fine;

uint8_t to_byte(double value)
{
	return static_cast<uint8_t>(std::lround(value));
}

} // namespace

Backdrop::Backdrop(const Room &room, const Lens &lens, const Sensor &sensor)
	: margin_(lens.margin()), columns_((lens.picture().width + 2 * lens.margin()) * fine)
{
	const Rect picture = lens.picture();
	std::vector<float> x, y, open, levels;
	lens.ideal(with_margin(picture, margin_), &x, &y);
	const double spread = 1 / (lens.camera().focal * fine);
	for (size_t i = 0; i < x.size(); i++) {
		const Sight sight = room.look(lens.ray(x[i], y[i]), spread);
		level_.push_back(static_cast<float>(sight.level));
		depth_.push_back(static_cast<float>(sight.depth));
		net_cover_.push_back(to_byte(255 * sight.net_cover));
		net_level_.push_back(to_byte(sight.net_level));
		const double z = lens.camera().centre.z() + sight.depth * lens.ray(x[i], y[i]).direction.z();
		open.push_back(z > people_z ? 1.0f : 0.0f);
	}
	lens.integrate(open, picture, &beyond_);
	lens.integrate(level_, picture, &levels);
	for (const float level : levels) {
		light_.push_back(sensor.light(level));
		deviation_.push_back(sensor.deviation(light_.back()));
	}
}

size_t Backdrop::index(int column, int row) const
{
	return static_cast<size_t>(row + margin_ * fine) * static_cast<size_t>(columns_) +
	       static_cast<size_t>(column + margin_ * fine);
}

void Backdrop::copy(const Rect &pixels, const Lens &lens, Samples *samples) const
{
	samples->columns = pixels.width * fine;
	samples->rows = pixels.height * fine;
	const size_t count = static_cast<size_t>(samples->columns) * static_cast<size_t>(samples->rows);
	lens.ideal(pixels, &samples->x, &samples->y);
	samples->cover.assign(count, 0.0f);
	samples->shine.assign(count, 0.0f);
	samples->level.clear();
	samples->depth.clear();
	for (int row = 0; row < samples->rows; row++) {
		const auto from = static_cast<std::ptrdiff_t>(index(pixels.u * fine, pixels.v * fine + row));
		const auto to = from + samples->columns;
		samples->level.insert(samples->level.end(), level_.begin() + from, level_.begin() + to);
		samples->depth.insert(samples->depth.end(), depth_.begin() + from, depth_.begin() + to);
	}
}

// Light of the room has come through the net already; only what the ball covers has to.
void Backdrop::add_net(const Rect &pixels, Samples *samples) const
{
	size_t i = 0;
	for (int row = 0; row < samples->rows; row++) {
		size_t from = index(pixels.u * fine, pixels.v * fine + row);
		for (int column = 0; column < samples->columns; column++, i++, from++) {
			const float net = net_cover_[from] / 255.0f;
			samples->shine[i] += net * (samples->cover[i] * net_level_[from] - samples->shine[i]);
		}
	}
}

const std::vector<Fixed> &Backdrop::light() const
{
	return light_;
}

const std::vector<Fixed> &Backdrop::deviation() const
{
	return deviation_;
}

const std::vector<float> &Backdrop::beyond() const
{
	return beyond_;
}

double Backdrop::depth(int u, int v) const
{
	return depth_[index(u * fine + fine / 2, v * fine + fine / 2)];
}

} // namespace sim
