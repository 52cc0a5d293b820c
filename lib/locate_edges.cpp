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

const double lens = 1.5;  // half of the width of a step that the lens and the pixels blur, px
const float beyond = 1.5; // how far the outside, where only background is seen, is watched, px
const int samples_max = 192;
const float contrast_needed = 5;              // between ball and background, grey levels
const float background_error = 6;             // of an earlier picture that shows what is behind the ball, grey levels
const double shading_error = 0.06;            // of an edge, px: brightness is not continued perfectly
const double noise_error = 2.5;               // of an edge: grey levels times pixels, over the contrast
const double common_error = 0.12;             // of the centre, px: what shading does to all edges of a side alike
const double seen_least = 0.7;                // of the rays of a ball that nothing covers
const int coarse_rays = 16;                   // of the first pass, which only tells where to look closely
const float coarse_step = 1, fine_step = 0.5; // between samples of a ray, px
const int passes = 2;

// The outline as far as it is known.
struct Circle {
	Vector2 centre;
	double radius;
	double uncertainty; // of the radius along any ray, px
	int rays;           // to look along
	float step;         // between their samples, px
};

// One ray's samples, at distances begin + i * step from the centre.
struct Profile {
	float begin, step;
	int count, watched; // samples; the last of them see background only
	int u[samples_max], v[samples_max];
	float right[samples_max], below[samples_max]; // of the pixel's corner, parts of a pixel
	float now[samples_max], background[samples_max];
	float facing[samples_max]; // the part of the surface normal that faces the camera: sqrt(1 - s^2 / r^2)

	float at(int i) const
	{
		return begin + static_cast<float>(i) * step;
	}
};

void lay_out(const Circle &circle, const Vector2 &direction, Profile &profile)
{
	const float u = static_cast<float>(circle.centre.x()), du = static_cast<float>(direction.x());
	const float v = static_cast<float>(circle.centre.y()), dv = static_cast<float>(direction.y());
	const float per_radius = static_cast<float>(1 / circle.radius);
	for (int i = 0; i < profile.count; i++) {
		const float s = profile.at(i), x = u + s * du, y = v + s * dv, part = s * per_radius;
		profile.u[i] = static_cast<int>(x);
		profile.v[i] = static_cast<int>(y);
		profile.right[i] = x - static_cast<float>(profile.u[i]);
		profile.below[i] = y - static_cast<float>(profile.v[i]);
		profile.facing[i] = std::sqrt(std::max(1 - part * part, 0.0f));
	}
}

// Between the four pixels around each place, linearly.
void sample(const pong_image &image, const Profile &profile, int first, float *out)
{
	for (int i = first; i < profile.count; i++) {
		const uint8_t *row = image.pixels + profile.v[i] * image.stride + profile.u[i];
		const uint8_t *next = row + image.stride;
		const float above = row[0] + profile.right[i] * static_cast<float>(row[1] - row[0]);
		const float under = next[0] + profile.right[i] * static_cast<float>(next[1] - next[0]);
		out[i] = above + profile.below[i] * (under - above);
	}
}

bool inside_picture(const pong_image &image, const Vector2 &at)
{
	return at.x() >= 0 && at.y() >= 0 && at.x() < image.width - 1 && at.y() < image.height - 1;
}

// The ends tell: a picture is convex. The circle's own centre may lie beside it.
bool inside_picture(const pong_image &image, const Circle &circle, const Vector2 &direction, const Profile &profile)
{
	const auto place = [&](int i) -> Vector2 {
		return circle.centre + static_cast<double>(profile.at(i)) * direction;
	};
	return inside_picture(image, place(0)) && inside_picture(image, place(profile.count));
}

// Take the background from the earlier picture that looks most like now outside of the ball; where neither does, what
// is seen outside just now continues inwards.
void fill_background(const pong_pictures &pictures, Profile &profile)
{
	const int first = profile.count - profile.watched;
	float least = background_error * static_cast<float>(profile.watched), outside = 0;
	const pong_image *best = nullptr;
	for (const pong_image &earlier : pictures.earlier) {
		sample(earlier, profile, first, profile.background);
		float error = 0;
		for (int i = first; i < profile.count; i++)
			error += std::abs(profile.now[i] - profile.background[i]);
		if (error < least) {
			least = error;
			best = &earlier;
		}
	}
	for (int i = first; i < profile.count; i++)
		outside += profile.now[i] / static_cast<float>(profile.watched);
	if (best)
		sample(*best, profile, 0, profile.background);
	else
		std::fill_n(profile.background, profile.count, outside);
}

// The ball's brightness on one ray, linear in how much its surface faces the camera: so a ball's shading runs out
// towards its outline.
struct Shading {
	float level, slope;

	float at(float facing) const
	{
		return level + slope * facing;
	}
};

const float slope_prior = 0.05f; // weight of "no slope" against the samples

// From the first samples of a ray.
Shading fit_shading(const Profile &profile, int count)
{
	float sum_n = 0, sum_nn = 0, sum_i = 0, sum_in = 0;
	for (int i = 0; i < count; i++) {
		const float n = profile.facing[i];
		sum_n += n;
		sum_nn += n * n;
		sum_i += profile.now[i];
		sum_in += n * profile.now[i];
	}
	if (count < 2)
		return {profile.now[0], 0};
	const float per_count = 1 / static_cast<float>(count);
	const float spread = sum_nn - sum_n * sum_n * per_count + slope_prior;
	const float slope = (sum_in - sum_n * sum_i * per_count) / spread;
	return {(sum_i - slope * sum_n) * per_count, slope};
}

// Where the edge is on one ray; its deviation is infinite where it can't be told.
EdgePoint find_edge(const LocateTask &task, const Circle &circle, const Vector2 &direction)
{
	const EdgePoint none = {{0, 0}, INFINITY};
	const double blur = lens + std::abs(task.streak.dot(direction)) / 2 + circle.uncertainty;
	const double depth = std::max(3.0, 0.2 * circle.radius); // of the ball's inside that tells its brightness
	Profile profile;
	profile.begin = static_cast<float>(std::max(0.0, circle.radius - blur - depth));
	profile.step = circle.step;
	profile.watched = static_cast<int>(beyond / circle.step);
	profile.count = static_cast<int>((static_cast<float>(circle.radius + blur) - profile.begin) / circle.step) + 1 +
			profile.watched;
	if (profile.count > samples_max || !inside_picture(task.pictures.current, circle, direction, profile))
		return none;
	lay_out(circle, direction, profile);
	sample(task.pictures.current, profile, 0, profile.now);
	fill_background(task.pictures, profile);
	// Up to here there is nothing but ball.
	const int inner =
		1 +
		static_cast<int>(std::lround(std::min(depth, circle.radius - blur) / static_cast<double>(circle.step)));
	if (inner < 2)
		return none;
	const Shading shading = fit_shading(profile, inner);
	float cover = static_cast<float>(inner), contrast = INFINITY;
	for (int i = inner; i < profile.count; i++) {
		const float ball = shading.at(profile.facing[i]) - profile.background[i];
		contrast = std::min(contrast, std::abs(ball));
		cover += (profile.now[i] - profile.background[i]) / ball;
	}
	if (!(contrast >= contrast_needed))
		return none;
	const double place = static_cast<double>(profile.begin + (cover - 0.5f) * circle.step);
	if (!(std::abs(place - circle.radius) < blur))
		return none;
	return {circle.centre + place * direction,
		std::hypot(shading_error, noise_error / static_cast<double>(contrast))};
}

int ray_count(double radius)
{
	return std::clamp(static_cast<int>(2.5 * radius), 24, 32);
}

bool fit_edges(const LocateTask &task, const Camera &camera, const Circle &circle, ConeFit *fit)
{
	EdgePoint points[edge_points_max];
	const int rays = circle.rays;
	int count = 0;
	const double cosine = std::cos(2 * M_PI / rays), sine = std::sin(2 * M_PI / rays);
	Vector2 direction(1, 0);
	for (int i = 0; i < rays; i++) {
		const EdgePoint point = find_edge(task, circle, direction);
		if (!std::isinf(point.deviation))
			points[count++] = point;
		direction = Vector2(cosine * direction.x() - sine * direction.y(),
				    sine * direction.x() + cosine * direction.y());
	}
	return 3 * count >= rays && fit_cone(camera, points, count, fit);
}

} // namespace

bool locate_edges(const LocateTask &task, pong_centre *centre)
{
	const Camera camera(task.camera);
	const double radius = task.detection.size / 2;
	Circle circle = {{task.detection.u, task.detection.v}, radius, 1 + 0.1 * radius, coarse_rays, coarse_step};
	ConeFit fit;
	for (int pass = 0; pass < passes; pass++) {
		if (!fit_edges(task, camera, circle, &fit))
			return false;
		circle = {fit.centre, fit.radius, 0.5, ray_count(fit.radius), fine_step};
	}
	const double scale = std::max(1.0, fit.residual);
	const Matrix2 covariance = scale * scale * fit.covariance + common_error * common_error * Matrix2::Identity();
	*centre = make_centre(fit.centre, fit.radius, covariance);
	centre->common = common_part;
	// What is hidden, or out of the picture, has no edge.
	const bool whole = inside_picture(task.pictures.current, fit.centre - Vector2::Constant(fit.radius)) &&
			   inside_picture(task.pictures.current, fit.centre + Vector2::Constant(fit.radius));
	if (!whole)
		centre->flags |= PONG_CENTRE_CUT;
	else if (fit.used < seen_least * circle.rays)
		centre->flags |= PONG_CENTRE_COVERED;
	return true;
}

} // namespace pong
