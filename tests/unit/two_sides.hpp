// Both cameras of the test rig, as an eye has them, before pictures drawn by the test.
#pragma once

#include "pictures.hpp"
#include "rigs.hpp"
#include "side.hpp"

class TwoSides
{
public:
	explicit TwoSides(pong_profile profile = PONG_BEST)
		: settings_(defaults(profile)), sides_{pong::Side(rig_, PONG_LEFT, settings_),
						       pong::Side(rig_, PONG_RIGHT, settings_)}
	{
	}

	// The next pair shows a room with what draw(picture, side) draws in it.
	template<class Draw> void show(Draw draw)
	{
		for (int side = 0; side < 2; side++) {
			sides_[side].keep();
			pictures_[side] = Picture(640, 480, 40);
			draw(pictures_[side], side);
			pictures_[side].add_noise(1.2, static_cast<unsigned>(shown_++));
			sides_[side].add(pictures_[side].image());
		}
	}

	void show_room()
	{
		show([](Picture &, int) {});
	}

	// Both search all of their pictures.
	void look()
	{
		for (pong::Side &side : sides_)
			side.look({});
	}

	// How a camera sees a ball at a place in the table frame.
	pong_detection ball_at(const double position[3], int side) const
	{
		pong_detection ball = {};
		double uv[2];
		pong_project(&rig_.camera[side], position, uv);
		ball.u = uv[0];
		ball.v = uv[1];
		ball.size = pong_apparent_size(&rig_.camera[side], position, rig_.ball.diameter);
		return ball;
	}

	void draw_ball(const double position[3], Picture &picture, int side, double brightness = 200) const
	{
		const pong_detection ball = ball_at(position, side);
		picture.draw_ball(ball.u, ball.v, ball.size / 2, brightness);
	}

	const pong_rig &rig() const
	{
		return rig_;
	}
	const pong_settings &settings() const
	{
		return settings_;
	}
	pong::Side *sides()
	{
		return sides_;
	}
	pong::Side &operator[](int side)
	{
		return sides_[side];
	}

private:
	static pong_settings defaults(pong_profile profile)
	{
		pong_settings settings;
		pong_settings_defaults(profile, &settings);
		return settings;
	}

	const pong_rig rig_ = test_rig();
	const pong_settings settings_;
	pong::Side sides_[2];
	Picture pictures_[2] = {Picture(640, 480, 40), Picture(640, 480, 40)};
	int shown_ = 0;
};
