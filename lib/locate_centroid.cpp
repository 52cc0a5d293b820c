// The centroid of how much of each pixel the ball covers.
#include <algorithm>

#include "difference.hpp"
#include "disc.hpp"
#include "locate.hpp"

namespace pong
{

// What is new at a pixel, over the ball's contrast, is how much the ball covers of it. What is newer than `full` covers
// it wholly, so that shading inside of the ball does not pull.
bool locate_centroid(const LocateTask &task, pong_centre *centre)
{
	const pong_pictures &pictures = task.pictures;
	const pong_detection &detection = task.detection;
	const auto value = [](const pong_image &image, int u, int v) { return image.pixels[v * image.stride + u]; };
	const double full = 0.3 * detection.contrast, none = 0.1 * detection.contrast;
	double weight = 0;
	Vector2 sum(0, 0);
	for_each_pixel(pictures.current, detection, 0.65 * detection.size + 1.5, [&](int u, int v) {
		const double difference = beyond_both(value(pictures.current, u, v), value(pictures.earlier[0], u, v),
						      value(pictures.earlier[1], u, v));
		const double cover = std::clamp((difference - none) / (full - none), 0.0, 1.0);
		weight += cover;
		sum += cover * Vector2(u, v);
	});
	if (!(weight > 1))
		return false;
	*centre = make_centre(sum / weight, detection.size / 2, task.sigma * task.sigma * Matrix2::Identity());
	return true;
}

} // namespace pong
