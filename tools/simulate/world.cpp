#include "world.hpp"

#include <algorithm>
#include <cmath>

#include "texture.hpp"

namespace sim
{

namespace
{

constexpr size_t remembered = 8;                 // episodes
constexpr int empty_frames = 8, ball_frames = 4; // of every resting place
constexpr int directions = 11, repeats = 2;
constexpr double launch_speeds[] = {7, 9.5, 13}; // m/s
constexpr int launches = directions * repeats * 3;

} // namespace

bool Episode::has_ball() const
{
	return flight || resting;
}

Ball Episode::ball(double time) const
{
	if (flight)
		return flight->at(time - begin);
	Ball ball;
	ball.position = *resting;
	return ball;
}

World::World(const Scene &scene, const Rig &rig, uint64_t seed, double rate, int board_frames)
	: scene_(scene), rig_(rig), seed_(seed), rate_(rate), board_frames_(board_frames)
{
	if (scene.show == Show::board)
		poses_ = draw_poses(scene.board, rig, seed);
}

int World::count() const
{
	switch (scene_.show) {
	case Show::launches:
		return launches;
	case Show::positions:
		return static_cast<int>(sixty_places().size());
	case Show::board:
		return static_cast<int>(poses_.size());
	case Show::flights:
		break;
	}
	return 0;
}

std::shared_ptr<const Episode> World::at(double time)
{
	const std::lock_guard<std::mutex> lock(mutex_);
	while (episodes_.empty() || episodes_.back()->end <= time)
		add_episode();
	for (const auto &episode : episodes_)
		if (time >= episode->begin && time < episode->end)
			return episode;
	return nullptr;
}

const Episode &World::add_until(int number)
{
	while (added_ < number)
		add_episode();
	return *episodes_.back();
}

double World::end_of(int episodes) const
{
	World ahead(scene_, rig_, seed_, rate_, board_frames_);
	const double trailing = scene_.show == Show::board ? 0 : scene_.flights.gap;
	return ahead.add_until(episodes).end + trailing;
}

double World::towards_bounce(int number, double part) const
{
	World ahead(scene_, rig_, seed_, rate_, board_frames_);
	const Episode &episode = ahead.add_until(number);
	constexpr double STEP = 0.001; // s
	double time = episode.begin;
	while (time < episode.end && episode.ball(time).velocity.y() >= 0)
		time += STEP; // a launch may rise
	while (time < episode.end && episode.ball(time).velocity.y() < 0)
		time += STEP;
	return episode.begin + part * (time - episode.begin);
}

void World::add_episode()
{
	Episode episode = {};
	episode.number = ++added_;
	// Every episode has a generator of its own, so that it does not depend on how the others were drawn.
	Random random(hash(seed_ * 1000003 + static_cast<uint64_t>(episode.number)));
	switch (scene_.show) {
	case Show::flights:
	case Show::launches:
		fill_flight(&episode, random, episodes_.empty() ? 0 : episodes_.back()->end);
		break;
	case Show::positions:
		fill_resting(&episode);
		break;
	case Show::board:
		fill_board(&episode);
		break;
	}
	episodes_.push_back(std::make_shared<const Episode>(std::move(episode)));
	if (episodes_.size() > remembered)
		episodes_.pop_front();
}

// The gap is a little longer or shorter each time, so that launches don't keep step with the frames.
void World::fill_flight(Episode *episode, Random &random, double free_from)
{
	const FlightSettings settings = scene_.show == Show::launches ? launch(episode->number - 1) : scene_.flights;
	const Planes planes = {scene_.hit_z, std::min(scene_.hit_z, -scene_.rig.behind) - 0.1};
	const double jitter = std::uniform_real_distribution<double>(0, 1)(random) / rate_;
	episode->flight = draw_flight(settings, planes, random);
	episode->begin = free_from + scene_.flights.gap + jitter;
	episode->end = episode->begin + episode->flight->duration();
}

// The paper's launch number `index`, again after 66: every speed in turn, at every speed all directions.
FlightSettings World::launch(int index) const
{
	index %= launches;
	const double speed = launch_speeds[index / (directions * repeats)];
	const double aim = -0.45 + 0.09 * (index / repeats % directions);
	FlightSettings settings = scene_.flights;
	settings.speed = {0.99 * speed, 1.01 * speed};
	settings.aim = {aim, aim};
	return settings;
}

void World::fill_resting(Episode *episode) const
{
	const std::vector<Eigen::Vector3d> places = sixty_places();
	const size_t index = static_cast<size_t>(episode->number - 1);
	const double first = static_cast<double>(index) * (empty_frames + ball_frames) + empty_frames;
	episode->resting = places[index % places.size()];
	episode->begin = (first - 0.5) / rate_;
	episode->end = (first + ball_frames - 0.5) / rate_;
}

void World::fill_board(Episode *episode) const
{
	const size_t index = static_cast<size_t>(episode->number - 1);
	episode->board = poses_[index % poses_.size()];
	episode->begin = (static_cast<double>(index) * board_frames_ - 0.5) / rate_;
	episode->end = episode->begin + board_frames_ / rate_;
}

std::vector<Eigen::Vector3d> sixty_places()
{
	std::vector<Eigen::Vector3d> places;
	for (const double y : {0.020, 0.220, 0.420})
		for (const double z : {0.70, 1.175, 1.65, 2.125, 2.60}) {
			// As far out as both of the default rig's cameras see, and the table is wide.
			const double reach = std::min(0.66, 0.296 * (z + 0.4) - 0.14);
			for (int i = 0; i < 4; i++)
				places.push_back({reach * (1 - 2 * i / 3.0), y, z});
		}
	return places;
}

} // namespace sim
