// A search of the left camera's pictures, drawn by the test.
#pragma once

#include "owned.hpp"
#include "pictures.hpp"
#include "rigs.hpp"

const int width = 640, height = 480;
const double noise = 1.5; // grey levels

class Search
{
public:
	explicit Search(pong_detect_method method) : rig_(test_rig())
	{
		pong_settings_defaults(PONG_BEST, &settings_);
		settings_.detect.method = method;
		region_.reset(pong_region_new(&rig_, PONG_LEFT, &settings_, nullptr));
		detector_ = new_detector();
	}

	pong::OwnedDetector new_detector() const
	{
		return pong::OwnedDetector(pong_detector_new(region_.get(), &settings_, nullptr));
	}

	// Look at three pictures, each with noise of its own.
	int look(Picture current, Picture earlier, Picture before, const pong_window *window = nullptr)
	{
		current.add_noise(noise, 1);
		earlier.add_noise(noise, 2);
		before.add_noise(noise, 3);
		const pong_pictures pictures = {current.image(), {earlier.image(), before.image()}};
		return pong_detect(detector_.get(), &pictures, window, found_, capacity);
	}

	static constexpr int capacity = 8;
	pong_detection found_[capacity];

private:
	pong_rig rig_;
	pong_settings settings_;
	pong::OwnedRegion region_; // outlives the detector
	pong::OwnedDetector detector_;
};

inline Picture with_ball(int background, double u, double v, double radius, double brightness)
{
	Picture picture(width, height, static_cast<uint8_t>(background));
	picture.draw_ball(u, v, radius, brightness);
	return picture;
}
