// The centre from the ball's outline. On rays from the detected centre, the place of the edge is where the ball ends
// and the background begins: along the ray the picture is
//
//     I(s) = cover(s) B(s) + (1 - cover(s)) E(s)
//
// with E the background, which an earlier picture shows, and B the ball's brightness, continued from inside. The edge
// lies where the cover adds up to: s0 = sum of cover(s) ds. Blur, by lens or motion, widens the step of cover but does
// not move that sum. A cone is then fitted to the edges of all rays.
#include <algorithm>
#include <cmath>

#include "cone.hpp"
#include "locate.hpp"

namespace pong
{

namespace
{

const double step = 0.5;   // between samples of a ray, px
const double lens = 1.5;   // half of the width of a step that the lens and the pixels blur, px
const double beyond = 1.5; // how far the outside, where only background is seen, is watched, px
const int samples_max = 256;
const double contrast_needed = 5;  // between ball and background, grey levels
const double background_error = 6; // of an earlier picture that shows what is behind the ball, grey levels
const double shading_error = 0.06; // of an edge, px: brightness is not continued perfectly
const double noise_error = 2.5;    // of an edge: grey levels times pixels, over the contrast
const double common_error = 0.12;  // of the centre, px: what shading does to all edges of a side alike
const int passes = 3;

// The outline as far as it is known.
struct Circle {
	Vector2 centre;
	double radius;
	double uncertainty; // of the radius along any ray, px
};

double sample(const pong_image &image, const Vector2 &at)
{
	const int u = static_cast<int>(at.x()), v = static_cast<int>(at.y());
	const double right = at.x() - u, below = at.y() - v;
	const uint8_t *row = image.pixels + v * image.stride + u, *next = row + image.stride;
	return (1 - below) * ((1 - right) * row[0] + right * row[1]) +
	       below * ((1 - right) * next[0] + right * next[1]);
}

bool inside_picture(const pong_image &image, const Vector2 &at)
{
	return at.x() >= 0 && at.y() >= 0 && at.x() < image.width - 1 && at.y() < image.height - 1;
}

// One ray's samples: distance s = begin + i * step from the centre.
struct Profile {
	double begin;
	int count, watched; // samples; the last of them see background only
	double now[samples_max], background[samples_max];
};

// Take the background from the earlier picture that looks most like now outside of the ball; where neither does, what
// is seen outside just now continues inwards.
void fill_background(const pong_pictures &pictures, const Vector2 &centre, const Vector2 &direction, Profile &profile)
{
	double least = background_error * profile.watched;
	const pong_image *best = nullptr;
	for (const pong_image &earlier : pictures.earlier) {
		double error = 0;
		for (int i = profile.count - profile.watched; i < profile.count; i++)
			error += std::abs(profile.now[i] -
					  sample(earlier, centre + (profile.begin + i * step) * direction));
		if (error < least) {
			least = error;
			best = &earlier;
		}
	}
	double outside = 0;
	for (int i = profile.count - profile.watched; i < profile.count; i++)
		outside += profile.now[i] / profile.watched;
	for (int i = 0; i < profile.count; i++)
		profile.background[i] = best ? sample(*best, centre + (profile.begin + i * step) * direction) : outside;
}

// The ball's brightness on one ray, linear in n = sqrt(1 - s^2 / r^2), the part of the surface normal that faces the
// camera: so a ball's shading runs out towards its outline.
struct Shading {
	double level, slope;

	double at(double n) const
	{
		return level + slope * n;
	}
};

double facing(double s, double radius)
{
	const double part = s / radius;
	return part < 1 ? std::sqrt(1 - part * part) : 0;
}

const double slope_prior = 0.05; // weight of "no slope" against the samples

Shading fit_shading(const Profile &profile, double until, double radius)
{
	double count = 0, sum_n = 0, sum_nn = 0, sum_i = 0, sum_in = 0;
	for (int i = 0; i < profile.count && profile.begin + i * step <= until; i++) {
		const double n = facing(profile.begin + i * step, radius);
		count++;
		sum_n += n;
		sum_nn += n * n;
		sum_i += profile.now[i];
		sum_in += n * profile.now[i];
	}
	if (count < 2)
		return {profile.now[0], 0};
	const double spread = sum_nn - sum_n * sum_n / count + slope_prior;
	const double slope = (sum_in - sum_n * sum_i / count) / spread;
	return {(sum_i - slope * sum_n) / count, slope};
}

// Where the edge is on one ray; its deviation is infinite where it can't be told.
EdgePoint find_edge(const LocateTask &task, const Circle &circle, const Vector2 &direction)
{
	const EdgePoint none = {{0, 0}, INFINITY};
	const double blur = lens + std::abs(task.streak.dot(direction)) / 2 + circle.uncertainty;
	const double depth = std::max(2.5, 0.2 * circle.radius); // of the ball's inside that tells its brightness
	Profile profile;
	profile.begin = std::max(0.0, circle.radius - blur - depth);
	profile.watched = static_cast<int>(beyond / step);
	profile.count = static_cast<int>((circle.radius + blur - profile.begin) / step) + 1 + profile.watched;
	if (profile.count > samples_max ||
	    !inside_picture(task.pictures.current, circle.centre + (profile.begin + profile.count * step) * direction))
		return none;
	for (int i = 0; i < profile.count; i++)
		profile.now[i] = sample(task.pictures.current, circle.centre + (profile.begin + i * step) * direction);
	fill_background(task.pictures, circle.centre, direction, profile);
	const double inner = std::max(profile.begin + 2 * step, circle.radius - blur);
	const Shading shading = fit_shading(profile, inner, circle.radius);
	double cover = 0, contrast = INFINITY;
	for (int i = 0; i < profile.count; i++) {
		const double s = profile.begin + i * step;
		if (s <= inner) {
			cover += 1;
			continue;
		}
		const double ball = shading.at(facing(s, circle.radius)) - profile.background[i];
		contrast = std::min(contrast, std::abs(ball));
		cover += (profile.now[i] - profile.background[i]) / ball;
	}
	if (!(contrast >= contrast_needed))
		return none;
	const double place = profile.begin + (cover - 0.5) * step;
	if (!(std::abs(place - circle.radius) < blur))
		return none;
	return {circle.centre + place * direction, std::hypot(shading_error, noise_error / contrast)};
}

int ray_count(double radius)
{
	return std::clamp(static_cast<int>(4 * radius), 24, edge_points_max);
}

bool fit_edges(const LocateTask &task, const Camera &camera, const Circle &circle, ConeFit *fit)
{
	EdgePoint points[edge_points_max];
	const int rays = ray_count(circle.radius);
	int count = 0;
	for (int i = 0; i < rays; i++) {
		const double angle = 2 * M_PI * i / rays;
		const EdgePoint point = find_edge(task, circle, {std::cos(angle), std::sin(angle)});
		if (!std::isinf(point.deviation))
			points[count++] = point;
	}
	return 3 * count >= rays && fit_cone(camera, points, count, fit);
}

} // namespace

bool locate_edges(const LocateTask &task, pong_centre *centre)
{
	const Camera camera(task.camera);
	const double radius = task.detection.size / 2;
	Circle circle = {{task.detection.u, task.detection.v}, radius, 1 + 0.1 * radius};
	ConeFit fit;
	for (int pass = 0; pass < passes; pass++) {
		if (!fit_edges(task, camera, circle, &fit))
			return false;
		circle = {fit.centre, fit.radius, 0.5};
	}
	*centre = {fit.centre.x(), fit.centre.y(), fit.radius, {}};
	const double scale = std::max(1.0, fit.residual);
	const Matrix2 covariance = scale * scale * fit.covariance + common_error * common_error * Matrix2::Identity();
	for (int i = 0; i < 2; i++)
		for (int j = 0; j < 2; j++)
			centre->covariance[i][j] = covariance(i, j);
	return true;
}

} // namespace pong
