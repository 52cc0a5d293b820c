#include "studio.hpp"

#include <cmath>

#include "program.hpp"

namespace bench
{

pong_pictures Shot::pictures(pong_side side) const
{
	const auto image = [&](size_t i) { return pong_image{pixels[side][i].data(), width, height, width}; };
	return {image(0), {image(1), image(2)}};
}

Studio::Studio(const sim::Scene &scene, uint64_t seed)
	: scene_(scene), cameras_(sim::make_rig(scene.rig)), renderers_{sim::Renderer(scene_, cameras_[0], seed, 0),
									sim::Renderer(scene_, cameras_[1], seed, 1)}
{
	pong_error error;
	if (pong_rig_parse(sim::rig_text(cameras_, scene.hit_z).c_str(), "simulated rig", &rig_, &error) < 0)
		throw pong::Failure(error.text);
}

sim::Episode Studio::make_episode(const Eigen::Vector3d &position, const Eigen::Vector3d &velocity, double lead) const
{
	sim::Episode episode = {1, 0, lead + 1, {}, {}, {}};
	if (velocity.norm() > 0) {
		sim::Ball launch;
		launch.position = position - lead * velocity;
		launch.velocity = velocity;
		const double end_z = position.z() + scene_.picture.exposure * velocity.z(); // soon after the exposure
		episode.flight = sim::Flight({}, launch, {end_z, end_z});
	} else {
		episode.resting = position;
	}
	return episode;
}

bool Studio::expose(const sim::Episode &episode, double time, Shot *shot)
{
	const sim::Ball middle = episode.ball(time);
	shot->time = time;
	shot->position = middle.position;
	shot->velocity = middle.velocity;
	const uint64_t frame = frame_++;
	shot->width = cameras_[0].width;
	shot->height = cameras_[0].height;
	for (size_t side = 0; side < 2; side++) {
		Eigen::Vector2d uv;
		if (!sim::wholly_seen(cameras_[side], middle.position) || !cameras_[side].project(middle.position, &uv))
			return false;
		shot->uv[side][0] = uv.x();
		shot->uv[side][1] = uv.y();
		for (size_t i = 0; i < 3; i++) {
			auto &pixels = shot->pixels[side][i];
			pixels.resize(static_cast<size_t>(shot->width) * static_cast<size_t>(shot->height));
			renderers_[side].render(i == 0 ? &episode : nullptr,
						{time, scene_.picture.exposure, 3 * frame + i}, pixels.data());
		}
	}
	return true;
}

bool Studio::take(const Eigen::Vector3d &position, const Eigen::Vector3d &velocity, Shot *shot)
{
	const double lead = 0.01; // s of flight before the exposure
	return expose(make_episode(position, velocity, lead), lead, shot);
}

std::vector<Shot> Studio::follow(const Eigen::Vector3d &position, const Eigen::Vector3d &velocity, int earlier,
				 double rate)
{
	const double lead = earlier / rate + 0.01;
	// From the middle height, neither through the table nor from above the pictures.
	const double middle = 0.25; // m
	Eigen::Vector3d in_sight = velocity;
	in_sight.y() = std::copysign(velocity.y(), position.y() - middle);
	// A ball at the table's surface would bounce in the exposure, or just before: it is raised until it does so
	// later.
	const Eigen::Vector3d clearance(0, 0.01, 0); // m
	Eigen::Vector3d raised = position;
	while (!make_episode(raised - clearance, in_sight, lead).flight->bounces().empty())
		raised.y() += 0.005;
	const sim::Episode episode = make_episode(raised, in_sight, lead);
	std::vector<Shot> shots;
	for (int i = earlier; i >= 0; i--) {
		Shot shot;
		if (expose(episode, lead - i / rate, &shot))
			shots.push_back(std::move(shot));
		else if (i == 0)
			shots.clear();
	}
	return shots;
}

} // namespace bench
