#include "renderer.hpp"

#include <algorithm>
#include <cmath>

#include "texture.hpp"

namespace sim
{

namespace
{

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int outline_points = 24;
constexpr double nearest = 0.1; // a ball this near to a camera, or behind it, is not drawn; depth, m

// The shadow under a lamp of some size: the higher the ball, the wider and the fainter.
struct Shadow {
	Vector3d middle; // on the table, m
	double width;    // standard deviation, m
	double depth;    // in its middle, 0 to 1

	Shadow(const Light &light, const Ball &ball)
	{
		const double height = std::max(ball.position.y() - ball_radius, 0.0);
		const Vector3d lamp = light.towards.normalized();
		width = 0.8 * ball_radius + 0.35 * height;
		const double spread = 0.8 * ball_radius / width;
		depth = lamp.y() > 0.2 ? light.shadow * spread * spread : 0;
		middle = lamp.y() > 0.2 ? Vector3d(ball.position - ball.position.y() / lamp.y() * lamp) : ball.position;
	}

	bool visible() const
	{
		return depth > 0.02;
	}

	// What is left of the light where a ray meets the table, at `depth_there`; 1 off the table.
	double factor(const Ray &ray, double depth_there) const
	{
		const Vector3d there = ray.origin + depth_there * ray.direction;
		if (std::abs(there.y()) > 1e-3)
			return 1;
		return 1 - depth * std::exp(-(there - middle).squaredNorm() / (2 * width * width));
	}
};

} // namespace

Renderer::Renderer(const Scene &scene, const Camera &camera, uint64_t seed, int side)
	: scene_(scene), lens_(camera, scene.picture.blur), sensor_(scene.picture.sensor, seed),
	  backdrop_(Room(scene.background, hash(seed)), lens_, sensor_), people_(scene.people, seed),
	  key_(hash(2 * seed + static_cast<uint64_t>(side) + 12345)), light_(backdrop_.light()),
	  deviation_(backdrop_.deviation())
{
	for (int v = 0; v < camera.height; v++)
		for (int u = 0; u < camera.width; u++) {
			const Vector3d direction = lens_.pixel_ray(u, v).direction;
			slope_x_.push_back(static_cast<float>(direction.x() / direction.z()));
			slope_y_.push_back(static_cast<float>(direction.y() / direction.z()));
		}
}

void Renderer::render(const Episode *episode, const Exposure &exposure, uint8_t *pixels)
{
	for (const Limb &limb : people_.limbs_at(exposure.time))
		draw_limb(limb);
	if (episode && episode->has_ball())
		draw_ball(*episode, exposure);
	if (episode && episode->board)
		draw_board(*episode);
	expose(exposure.frame, pixels);
	restore();
}

size_t Renderer::pixel(int u, int v) const
{
	return static_cast<size_t>(v) * static_cast<size_t>(lens_.picture().width) + static_cast<size_t>(u);
}

// The pixels within reach of points of the table frame, the blur included.
Rect Renderer::seen_rect(const std::vector<Vector3d> &points) const
{
	Rect rect = {};
	for (const Vector3d &point : points) {
		Vector2d uv;
		if (lens_.camera().project(point, &uv))
			rect = grown(rect, uv.x(), uv.y());
	}
	return intersection(with_margin(rect, lens_.margin() + 1), lens_.picture());
}

Rect Renderer::limb_rect(const Limb &limb) const
{
	std::vector<Vector3d> corners;
	for (const Vector2d &end : {limb.from, limb.to})
		for (const double dx : {-limb.radius, limb.radius})
			for (const double dy : {-limb.radius, limb.radius})
				corners.push_back({end.x() + dx, end.y() + dy, limb.z});
	return seen_rect(corners);
}

// In pixels: its edge may fade over two of them, as the blur would make it.
void Renderer::draw_limb(const Limb &limb)
{
	const Rect rect = limb_rect(limb);
	const double distance = limb.z - lens_.camera().centre.z();
	const double softness = 2 * distance / lens_.camera().focal;
	for (int v = rect.v; v < rect.bottom(); v++)
		for (size_t i = pixel(rect.u, v); i < pixel(rect.u, v) + static_cast<size_t>(rect.width); i++) {
			if (backdrop_.beyond()[i] == 0)
				continue;
			const Vector2d slope(slope_x_[i], slope_y_[i]);
			double level = 0;
			const double cover = look_at_limb(limb, lens_.camera().centre.head<2>() + distance * slope,
							  softness, &level);
			const double behind = Sensor::level(light_[i]);
			if (cover > 0)
				light_[i] = Sensor::light(behind + cover * backdrop_.beyond()[i] * (level - behind));
		}
	if (!rect.empty())
		touched_.push_back(rect);
}

// In pixels: a shadow has no edges.
void Renderer::draw_shadow(const Ball &ball)
{
	const Shadow shadow(scene_.light, ball);
	if (!shadow.visible())
		return;
	std::vector<Vector3d> corners;
	for (const double dx : {-3 * shadow.width, 3 * shadow.width})
		for (const double dz : {-3 * shadow.width, 3 * shadow.width})
			corners.push_back(shadow.middle + Vector3d(dx, 0, dz));
	const Rect rect = seen_rect(corners);
	for (int v = rect.v; v < rect.bottom(); v++)
		for (int u = rect.u; u < rect.right(); u++) {
			const double factor = shadow.factor(lens_.pixel_ray(u, v), backdrop_.depth(u, v));
			Fixed &light = light_[pixel(u, v)];
			light = Sensor::light(factor * Sensor::level(light));
		}
	if (!rect.empty())
		touched_.push_back(rect);
}

void Renderer::draw_ball(const Episode &episode, const Exposure &exposure)
{
	std::vector<Vector3d> outline;
	for (const double part : {-0.5, 0.0, 0.5}) {
		const Ball ball = episode.ball(exposure.time + part * exposure.duration);
		if (lens_.camera().to_camera(ball.position).z() < nearest)
			return;
		const auto points = sphere_outline(lens_.camera(), ball.position, outline_points);
		outline.insert(outline.end(), points.begin(), points.end());
	}
	const Ball middle = episode.ball(exposure.time);
	draw_shadow(middle);
	const Rect rect = seen_rect(outline);
	if (rect.empty())
		return;
	begin_samples(with_margin(rect, lens_.margin()), exposure.time, middle);
	expose_ball(episode, exposure);
	if (middle.position.z() > net_z)
		backdrop_.add_net(with_margin(rect, lens_.margin()), &samples_);
	for (size_t i = 0; i < samples_.level.size(); i++)
		samples_.level[i] += samples_.shine[i] - samples_.cover[i] * samples_.level[i];
	lens_.integrate(samples_.level, rect, &levels_);
	put(rect, levels_);
}

void Renderer::begin_samples(const Rect &pixels, double time, const Ball &ball)
{
	backdrop_.copy(pixels, lens_, &samples_);
	const Shadow shadow(scene_.light, ball);
	for (size_t i = 0; shadow.visible() && i < samples_.level.size(); i++)
		samples_.level[i] *=
			static_cast<float>(shadow.factor(lens_.ray(samples_.x[i], samples_.y[i]), samples_.depth[i]));
	for (const Limb &limb : people_.limbs_at(time)) {
		if (intersection(limb_rect(limb), pixels).empty())
			continue;
		const double softness = (limb.z - lens_.camera().centre.z()) / lens_.camera().focal / Lens::fine;
		for (size_t i = 0; i < samples_.level.size(); i++) {
			if (samples_.depth[i] < limb.z - lens_.camera().centre.z())
				continue;
			double level = 0;
			const double cover = look_at_limb(limb, on_plane(limb, lens_.ray(samples_.x[i], samples_.y[i])),
							  softness, &level);
			samples_.level[i] += static_cast<float>(cover * (level - samples_.level[i]));
		}
	}
}

// The ball at moments of the exposure, less than a pixel apart: the blur leaves no trace of the steps. Where there are
// several, each is drawn on every third row of samples in turn: integration over a pixel, which is three rows, cannot
// tell.
void Renderer::expose_ball(const Episode &episode, const Exposure &exposure)
{
	const auto place = [&](double part) {
		Vector2d uv(0, 0);
		lens_.camera().project(episode.ball(exposure.time + part * exposure.duration).position, &uv);
		return uv;
	};
	const double way = (place(0.5) - place(-0.5)).norm();
	const int moments = way < 0.05 ? 1 : 3 * std::clamp(static_cast<int>(std::ceil(way / 3 / 0.7)), 1, 8);
	for (int i = 0; i < moments; i++) {
		const double part = (i + 0.5) / moments - 0.5;
		const Ball ball = episode.ball(exposure.time + part * exposure.duration);
		const int skip = moments == 1 ? 1 : Lens::fine;
		const Share share = {static_cast<float>(skip) / static_cast<float>(moments), i % skip, skip};
		draw_sphere(lens_.camera(), scene_.light, ball, share, &samples_);
	}
}

void Renderer::draw_board(const Episode &episode)
{
	if (board_number_ != episode.number) {
		board_number_ = episode.number;
		board_rect_ = seen_rect(outline(scene_.board, *episode.board));
		const Rect around = with_margin(board_rect_, lens_.margin());
		board_levels_.clear();
		if (board_rect_.empty())
			return;
		backdrop_.copy(around, lens_, &samples_);
		for (size_t i = 0; i < samples_.level.size(); i++) {
			double level;
			const Ray ray = lens_.ray(samples_.x[i], samples_.y[i]);
			if (look_at_board(scene_.board, *episode.board, ray, &level))
				samples_.level[i] = static_cast<float>(level);
		}
		lens_.integrate(samples_.level, board_rect_, &board_levels_);
	}
	if (!board_rect_.empty())
		put(board_rect_, board_levels_);
}

void Renderer::put(const Rect &pixels, const std::vector<float> &levels)
{
	for (int v = 0; v < pixels.height; v++)
		for (int u = 0; u < pixels.width; u++)
			light_[pixel(pixels.u + u, pixels.v + v)] =
				Sensor::light(levels[static_cast<size_t>(v * pixels.width + u)]);
	touched_.push_back(pixels);
}

void Renderer::expose(uint64_t frame, uint8_t *pixels)
{
	for (const Rect &rect : touched_)
		for (int v = rect.v; v < rect.bottom(); v++)
			for (size_t i = pixel(rect.u, v); i < pixel(rect.u, v) + static_cast<size_t>(rect.width); i++)
				deviation_[i] = sensor_.deviation(light_[i]);
	const Rect picture = lens_.picture();
	for (int v = 0; v < picture.height; v++) {
		const size_t row = pixel(0, v);
		const uint64_t key =
			hash(key_ + frame * static_cast<uint64_t>(picture.height) + static_cast<uint64_t>(v));
		sensor_.expose(&light_[row], &deviation_[row], picture.width, key, pixels + row);
	}
}

// Back to the empty room.
void Renderer::restore()
{
	for (const Rect &rect : touched_)
		for (int v = rect.v; v < rect.bottom(); v++) {
			const auto begin = static_cast<std::ptrdiff_t>(pixel(rect.u, v)), end = begin + rect.width;
			std::copy(backdrop_.light().begin() + begin, backdrop_.light().begin() + end,
				  light_.begin() + begin);
			std::copy(backdrop_.deviation().begin() + begin, backdrop_.deviation().begin() + end,
				  deviation_.begin() + begin);
		}
	touched_.clear();
}

bool wholly_seen(const Camera &camera, const Vector3d &position)
{
	if (camera.to_camera(position).z() < nearest)
		return false;
	for (const Vector3d &point : sphere_outline(camera, position, 64)) {
		Vector2d uv;
		if (!camera.project(point, &uv) || uv.minCoeff() < -0.5 || uv.x() > camera.width - 0.5 ||
		    uv.y() > camera.height - 0.5 || hidden(camera.centre, point))
			return false;
	}
	return true;
}

} // namespace sim
