#include "eye_scene.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <thread>

#include "allocations.hpp"

namespace
{

const double fps = 110, lamp = 100; // Hz
const double begin[3] = {0.1, 0.25, 3.3}, speed[3] = {0.2, 1.6, -6};

int64_t utime_of(int frame)
{
	return std::llround(frame * 1e6 / fps);
}

} // namespace

Scene::Scene(pong_profile profile) : rig_(test_rig())
{
	pong_settings settings;
	pong_settings_defaults(profile, &settings);
	eye_.reset(pong_eye_new(&rig_, &settings, nullptr));
	restart();
}

int Scene::push(bool ball)
{
	frame_++;
	const double t = 1 / fps;
	for (int axis = 0; axis < 3; axis++)
		position_[axis] += velocity_[axis] * t;
	position_[1] -= 9.8 / 2 * t * t;
	velocity_[1] -= 9.8 * t;
	const Picture pictures[2] = {draw(ball, PONG_LEFT), draw(ball, PONG_RIGHT)};
	const pong_image left = pictures[0].image(), right = pictures[1].image();
	const int64_t utime = utime_of(frame_);
	const long allocations_before = allocations();
	const int code = in_two_threads ? push_in_two_threads(utime, left, right)
					: pong_eye_push(eye_.get(), utime, frame_, &left, &right, &sight, &error);
	allocated += allocations() - allocations_before;
	return code;
}

int Scene::push_many(int frames)
{
	int found = 0;
	for (int i = 0; i < frames; i++)
		found += push(true) == PONG_FOUND;
	return found;
}

Picture Scene::draw(bool ball, int side) const
{
	Picture picture(640, 480, 40);
	if (clutter)
		draw_arm(picture);
	if (behind)
		behind(picture, side);
	if (ball)
		draw_ball_at(position_, picture, side);
	if (before)
		before(picture, side);
	if (flicker > 0)
		picture.brighten(1 + flicker * std::sin(2 * M_PI * lamp * frame_ / fps));
	picture.add_noise(1.2, static_cast<unsigned>(2 * frame_ + side));
	return picture;
}

void Scene::draw_ball_at(const double position[3], Picture &picture, int side) const
{
	double uv[2];
	pong_project(&rig_.camera[side], position, uv);
	picture.draw_ball(uv[0], uv[1], pong_apparent_size(&rig_.camera[side], position, 0.040) / 2, 200);
}

void Scene::draw_arm(Picture &picture) const
{
	const double end = 250 + 4 * (frame_ % 20);
	for (double u = end; u < end + 200; u += 5)
		picture.draw_ball(u, 200 + 0.3 * (u - end), 12, 130);
}

int Scene::push_in_two_threads(int64_t utime, const pong_image &left, const pong_image &right)
{
	EXPECT_EQ(pong_eye_expect(eye_.get(), utime), PONG_FOUND);
	std::thread other([this, &left] { pong_eye_look(eye_.get(), PONG_LEFT, &left, nullptr); });
	pong_eye_look(eye_.get(), PONG_RIGHT, &right, nullptr);
	other.join();
	const int seen = pong_eye_join(eye_.get(), frame_, &sight);
	EXPECT_FALSE(sight.has_prediction);
	pong_eye_predict(eye_.get(), &sight);
	pong_eye_keep(eye_.get());
	return seen;
}

void Scene::serve(const double position[3], const double velocity[3])
{
	std::copy_n(position, 3, position_);
	std::copy_n(velocity, 3, velocity_);
}

void Scene::restart()
{
	serve(begin, speed);
}

int64_t Scene::next_utime() const
{
	return utime_of(frame_ + 1);
}

double Scene::error_to_truth() const
{
	return std::hypot(sight.ball.position[0] - position_[0], sight.ball.position[1] - position_[1],
			  sight.ball.position[2] - position_[2]);
}

double Scene::hit_x() const
{
	return position_[0] - velocity_[0] * position_[2] / velocity_[2];
}
