// One camera's pictures: the room drawn once, what moves drawn into every picture, and the sensor's noise.
#pragma once

#include "backdrop.hpp"
#include "people.hpp"
#include "scene.hpp"
#include "world.hpp"

namespace sim
{

// When a picture is exposed.
struct Exposure {
	double time;     // of its middle, s of the world
	double duration; // s
	uint64_t frame;  // tells the noise of pictures apart
};

// For one thread at a time.
class Renderer
{
public:
	// `seed` is the world's; `side` (0 left, 1 right) gives each camera noise of its own.
	Renderer(const Scene &scene, const Camera &camera, uint64_t seed, int side);

	// The picture, pixels[width * height], of an episode, or of the empty room where it is null.
	void render(const Episode *episode, const Exposure &exposure, uint8_t *pixels);

private:
	void draw_limb(const Limb &limb);
	void draw_shadow(const Ball &ball);
	void draw_ball(const Episode &episode, const Exposure &exposure);
	void draw_board(const Episode &episode);
	// The samples around `pixels` with all that stands behind the ball.
	void begin_samples(const Rect &pixels, double time, const Ball &ball);
	void expose_ball(const Episode &episode, const Exposure &exposure);
	void put(const Rect &pixels, const std::vector<float> &levels);
	void expose(uint64_t frame, uint8_t *pixels);
	void restore();
	size_t pixel(int u, int v) const;
	Rect seen_rect(const std::vector<Eigen::Vector3d> &points) const;
	Rect limb_rect(const Limb &limb) const;

	const Scene scene_;
	const Lens lens_;
	const Sensor sensor_;
	const Backdrop backdrop_;
	const People people_;
	const uint64_t key_;
	std::vector<float> slope_x_, slope_y_; // of the pixels' rays: x and y over z

	// The picture in the making: the backdrop, but in the touched rectangles.
	std::vector<Fixed> light_, deviation_;
	std::vector<Rect> touched_;
	Samples samples_;
	std::vector<float> levels_;
	// The board that was drawn last: it rests for a while.
	int board_number_ = 0;
	Rect board_rect_ = {};
	std::vector<float> board_levels_;
};

// Whether a camera sees the whole ball: its outline within the picture, and neither table nor net before it.
bool wholly_seen(const Camera &camera, const Eigen::Vector3d &position);

} // namespace sim
