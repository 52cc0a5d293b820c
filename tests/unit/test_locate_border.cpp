// Whatever stands at the border, and whatever is asked, no method reads beside the picture: it lies between pages that
// nobody may touch.
#include <cstring>
#include <gtest/gtest.h>
#include <random>
#include <sys/mman.h>
#include <unistd.h>

#include "pictures.hpp"
#include "rigs.hpp"

namespace
{

// A copy of a picture whose pixels fill whole pages.
class GuardedPicture
{
public:
	explicit GuardedPicture(const pong_image &image)
		: image_(image), page_(static_cast<size_t>(sysconf(_SC_PAGESIZE)))
	{
		const size_t size = static_cast<size_t>(image.height) * static_cast<size_t>(image.stride);
		EXPECT_EQ(size % page_, 0u);
		mapped_ = size + 2 * page_;
		memory_ = static_cast<uint8_t *>(
			mmap(nullptr, mapped_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
		memcpy(memory_ + page_, image.pixels, size);
		mprotect(memory_, page_, PROT_NONE);
		mprotect(memory_ + page_ + size, page_, PROT_NONE);
		image_.pixels = memory_ + page_;
	}

	~GuardedPicture()
	{
		munmap(memory_, mapped_);
	}

	GuardedPicture(const GuardedPicture &) = delete;
	GuardedPicture &operator=(const GuardedPicture &) = delete;

	const pong_image &image() const
	{
		return image_;
	}

private:
	pong_image image_;
	size_t page_, mapped_;
	uint8_t *memory_;
};

using Random = std::mt19937;

double between(Random &random, double least, double most)
{
	return std::uniform_real_distribution<double>(least, most)(random);
}

// A place on the border of the picture, or near it.
void place_on_border(Random &random, const pong_camera &camera, double *u, double *v)
{
	*u = between(random, 0, camera.width - 1);
	*v = between(random, 0, camera.height - 1);
	const double off = between(random, -15, 15);
	switch (random() % 4) {
	case 0:
		*u = off;
		break;
	case 1:
		*u = camera.width - 1 + off;
		break;
	case 2:
		*v = off;
		break;
	default:
		*v = camera.height - 1 + off;
	}
}

class AtTheBorder : public ::testing::TestWithParam<pong_locate_method>
{
};

TEST_P(AtTheBorder, NothingBesideThePictureIsRead)
{
	const pong_camera camera = test_rig().camera[PONG_LEFT];
	pong_settings settings;
	pong_settings_defaults(PONG_BEST, &settings);
	settings.locate.method = GetParam();
	Random random(7);
	Picture empty(camera.width, camera.height, 60);
	empty.add_noise(1.5, 1);
	const GuardedPicture earlier(empty.image());
	int found = 0;
	for (int round = 0; round < 20; round++) {
		Picture picture(camera.width, camera.height, 60);
		std::vector<pong_detection> detections;
		for (int i = 0; i < 40; i++) {
			pong_detection detection = {0, 0, between(random, 6, 60), 100};
			place_on_border(random, camera, &detection.u, &detection.v);
			picture.draw_ball(detection.u, detection.v, detection.size / 2, between(random, 0, 255));
			detection.u += between(random, -0.5, 0.5) * detection.size;
			detection.v += between(random, -0.5, 0.5) * detection.size;
			detection.size *= between(random, 0.7, 1.4);
			detections.push_back(detection);
		}
		picture.add_noise(1.5, static_cast<unsigned>(round));
		const GuardedPicture current(picture.image());
		const pong_pictures pictures = {current.image(), {earlier.image(), earlier.image()}};
		for (const pong_detection &detection : detections) {
			const double streak[3] = {between(random, -40, 40), between(random, -40, 40), 0};
			pong_centre centre;
			found += pong_locate(&camera, &pictures, &detection, streak, &settings, &centre);
		}
	}
	EXPECT_GT(found, 0); // some of it was a ball
}

INSTANTIATE_TEST_SUITE_P(Locate, AtTheBorder,
			 ::testing::Values(PONG_LOCATE_GAUSSIAN, PONG_LOCATE_CENTROID, PONG_LOCATE_EDGES,
					   PONG_LOCATE_PHOTOMETRIC));

} // namespace
