// Flights drawn by the test, and pushed to an eye pair by pair.
#pragma once

#include <functional>

#include "owned.hpp"
#include "pictures.hpp"
#include "rigs.hpp"

// A ball on a parabola, drawn as a disc in both pictures.
class Scene
{
public:
	explicit Scene(pong_profile profile);

	// One frame: with the ball or without.
	int push(bool ball);
	// So many of them with it. Returns in how many it was found.
	int push_many(int frames);

	// The ball is somewhere else, and flies as if it had been served from there.
	void serve(const double position[3], const double velocity[3]);
	void restart();

	// A second ball, which does not fly by itself.
	void draw_ball_at(const double position[3], Picture &picture, int side) const;

	int64_t next_utime() const;
	double error_to_truth() const;
	double hit_x() const; // where the parabola comes to z = 0

	pong_eye *eye() const
	{
		return eye_.get();
	}
	const pong_rig &rig() const
	{
		return rig_;
	}
	int frame() const // the last one pushed, from 1
	{
		return frame_;
	}
	const double *position() const
	{
		return position_;
	}

	pong_sight sight = {};
	pong_error error = {};
	long allocated = 0;
	bool in_two_threads = false;
	bool clutter = false; // an arm moves behind the ball
	double flicker = 0;   // of the lamp, at 100 Hz: this part of the brightness
	std::function<void(Picture &picture, int side)> behind,
		before; // what else is drawn, behind the ball and before

private:
	Picture draw(bool ball, int side) const;
	void draw_arm(Picture &picture) const;
	int push_in_two_threads(int64_t utime, const pong_image &left, const pong_image &right);

	pong_rig rig_;
	pong::OwnedEye eye_;
	double position_[3], velocity_[3];
	int frame_ = 0;
};
