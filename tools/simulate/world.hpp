// What happens when: the world's episodes, one after another, each a flight, a resting ball, or a pose of the board.
#pragma once

#include <deque>
#include <memory>
#include <mutex>
#include <optional>

#include "board.hpp"
#include "scene.hpp"

namespace sim
{

struct Episode {
	int number;        // 1 for the first
	double begin, end; // shown from begin up to, but not at, end; s
	// One of these is there.
	std::optional<Flight> flight;
	std::optional<Eigen::Vector3d> resting; // place of a ball that does not move, m
	std::optional<BoardPose> board;

	bool has_ball() const;
	// The ball at a time of the world.
	Ball ball(double time) const;
};

class World
{
public:
	// `rate` frames a second; each pose of the board is shown for `board_frames` frames.
	World(const Scene &scene, const Rig &rig, uint64_t seed, double rate, int board_frames);

	// How many episodes the scene has before it begins anew; 0 where each is new.
	int count() const;

	// The episode at a time, s; null between episodes. Times may go back by a few episodes only. Any thread.
	std::shared_ptr<const Episode> at(double time);

	// While flight `number` is under way: this part (0 .. 1) of its time from the launch to its first bounce, s.
	double towards_bounce(int number, double part) const;

	// When the first `episodes` episodes are over and the world has been empty for a while, s.
	double end_of(int episodes) const;

private:
	const Episode &add_until(int number);
	void add_episode();
	void fill_flight(Episode *episode, Random &random, double free_from);
	void fill_resting(Episode *episode) const;
	void fill_board(Episode *episode) const;
	FlightSettings launch(int index) const;

	const Scene scene_;
	const Rig rig_;
	const uint64_t seed_;
	const double rate_;
	const int board_frames_;
	std::vector<BoardPose> poses_;
	std::mutex mutex_;
	std::deque<std::shared_ptr<const Episode>> episodes_; // the last few
	int added_ = 0;
};

// The paper's 60 places (section 7): 20 over the table, on it and 20 cm and 40 cm above.
std::vector<Eigen::Vector3d> sixty_places();

} // namespace sim
