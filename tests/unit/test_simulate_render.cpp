#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tools/simulate/lens.hpp"
#include "tools/simulate/renderer.hpp"

namespace
{

using Eigen::Vector2d;
using Eigen::Vector3d;

struct Blob {
	Vector2d centroid = Vector2d::Zero(); // px
	double area = 0;                      // px^2
};

// A ball that glows evenly before an even wall, without noise: what it adds to the picture is its outline's area.
sim::Scene plain_scene()
{
	return sim::parse_scene("[light]\nlevel = 240\nambient = 1\nhemisphere = 0\ndiffuse = 0\nshadow = 0\n"
				"[background]\nlevel = 10\ncontrast = 0\n[picture]\nnoise = false\n",
				"plain");
}

sim::Episode resting(const Vector3d &place)
{
	sim::Episode episode = {};
	episode.number = 1;
	episode.end = 1;
	episode.resting = place;
	return episode;
}

// By the pixels: how much brighter than the empty room.
Blob rendered(sim::Renderer &renderer, const sim::Episode &episode, const sim::Exposure &exposure)
{
	std::vector<uint8_t> empty(640 * 480), picture(640 * 480);
	renderer.render(nullptr, exposure, empty.data());
	renderer.render(&episode, exposure, picture.data());
	Blob blob;
	for (int v = 0; v < 480; v++)
		for (int u = 0; u < 640; u++) {
			const size_t i = static_cast<size_t>(v * 640 + u);
			const double part = (picture[i] - empty[i]) / 230.0;
			blob.area += part;
			blob.centroid += part * Vector2d(u, v);
		}
	blob.centroid /= blob.area;
	return blob;
}

// By brute force: 10 x 10 rays a pixel, each of which passes the centre within the radius or does not.
Blob outlined(const sim::Camera &camera, const Vector3d &place)
{
	const Vector3d centre = camera.to_camera(place);
	Vector2d middle;
	EXPECT_TRUE(camera.project(place, &middle));
	Blob blob;
	for (double u = std::floor(middle.x()) - 40.05; u < middle.x() + 40; u += 0.1)
		for (double v = std::floor(middle.y()) - 40.05; v < middle.y() + 40; v += 0.1) {
			const Vector3d ray = camera.ideal({u, v}).homogeneous().normalized();
			if (centre.cross(ray).norm() > 0.020)
				continue;
			blob.area += 0.01;
			blob.centroid += 0.01 * Vector2d(u, v);
		}
	blob.centroid /= blob.area;
	return blob;
}

// The left camera's, made once: drawing the room takes a while.
sim::Renderer &plain_renderer()
{
	static sim::Renderer renderer(plain_scene(), sim::make_rig({})[0], 1, 0);
	return renderer;
}

TEST(SimulateRender, BallLiesWhereRaysMeetIt)
{
	for (const Vector3d &place : {Vector3d(0.2, 0.35, 1.9), Vector3d(-0.1, 0.4, 0.9), Vector3d(0.0, 0.3, 3.0)}) {
		const Blob seen = rendered(plain_renderer(), resting(place), {0.5, 0.002, 3});
		const Blob expected = outlined(sim::make_rig({})[0], place);
		EXPECT_LT((seen.centroid - expected.centroid).norm(), 0.02);
		EXPECT_NEAR(seen.area / expected.area, 1, 0.005);
	}
}

TEST(SimulateRender, SoItDoesThroughABadLens)
{
	sim::Scene scene = plain_scene();
	scene.rig.distortion = {-0.2, 0.05, 0.001, 0.002, 0};
	const Vector3d place(0.45, 0.38, 1.9);
	const sim::Camera camera = sim::make_rig(scene.rig)[0];
	sim::Renderer renderer(scene, camera, 1, 0);
	const Blob seen = rendered(renderer, resting(place), {0.5, 0.002, 3});
	const Blob expected = outlined(camera, place);
	EXPECT_LT((seen.centroid - expected.centroid).norm(), 0.02);
	EXPECT_NEAR(seen.area / expected.area, 1, 0.005);
}

// A ball that moves is smeared along its way about where it is in the middle of the exposure.
TEST(SimulateRender, MotionIsSmearedAboutTheMiddle)
{
	sim::Ball launch;
	launch.position = {0.1, 0.38, 2.2};
	launch.velocity = {-12, 0, 0};
	sim::Episode episode = {};
	episode.end = 1;
	episode.flight.emplace(sim::Coefficients(), launch, sim::Planes());
	const Blob seen = rendered(plain_renderer(), episode, {0.008, 0.002, 3});
	const Blob expected = outlined(sim::make_rig({})[0], episode.ball(0.008).position);
	EXPECT_LT((seen.centroid - expected.centroid).norm(), 0.03);
	EXPECT_NEAR(seen.area / expected.area, 1, 0.01);
}

// Behind the net's tape there is nothing to see of it, before the net all.
TEST(SimulateRender, NetHidesWhatIsBehindIt)
{
	const sim::Camera camera = sim::make_rig({})[0];
	// On the line from the camera through the middle of the tape.
	const Vector3d tape(0, 0.145, 1.37), way = tape - camera.centre;
	const Vector3d before = camera.centre + 0.9 * way, behind = camera.centre + 1.1 * way;
	const double before_area = rendered(plain_renderer(), resting(before), {0.5, 0, 3}).area;
	const double behind_area = rendered(plain_renderer(), resting(behind), {0.5, 0, 3}).area;
	EXPECT_LT(behind_area, 0.75 * before_area * std::pow(0.9 / 1.1, 2));
	EXPECT_TRUE(sim::wholly_seen(camera, before));
	EXPECT_FALSE(sim::wholly_seen(camera, behind));
}

TEST(SimulateRender, WhollySeenEndsAtTheBorder)
{
	const sim::Camera camera = sim::make_rig({})[0];
	const auto at_pixel = [&](double u, double v) {
		const Vector3d ray = camera.ideal({u, v}).homogeneous();
		return Vector3d(camera.centre + camera.R_cam_table.transpose() * 2.0 * ray);
	};
	const double radius = 0.020 / 2.0 * camera.focal; // 10.8 px
	EXPECT_TRUE(sim::wholly_seen(camera, at_pixel(radius + 1, 100)));
	EXPECT_FALSE(sim::wholly_seen(camera, at_pixel(radius - 2, 100)));
	EXPECT_TRUE(sim::wholly_seen(camera, at_pixel(300, radius + 1)));
	EXPECT_FALSE(sim::wholly_seen(camera, at_pixel(300, radius - 2)));
	EXPECT_FALSE(sim::wholly_seen(camera, {0, 0.5, -0.6}));
}

// What is wholly outside of the picture has no part in it, rather than one of negative size.
TEST(SimulateRender, RectanglesApartShareNothing)
{
	const sim::Rect shared = sim::intersection({700, 500, 20, 20}, {0, 0, 640, 480});
	EXPECT_TRUE(shared.empty());
	EXPECT_EQ(shared.width, 0);
	EXPECT_EQ(shared.height, 0);
}

TEST(SimulateRender, OneSeedOnePicture)
{
	const sim::Scene scene = sim::load_scene("people");
	const sim::Camera camera = sim::make_rig(scene.rig)[0];
	sim::Renderer once(scene, camera, 5, 0), again(scene, camera, 5, 0), other(scene, camera, 6, 0);
	const sim::Episode episode = resting({0.1, 0.3, 1.5});
	std::vector<uint8_t> a(640 * 480), b(640 * 480), c(640 * 480);
	once.render(&episode, {0.2, 0.002, 1}, c.data());
	once.render(&episode, {0.3, 0.002, 2}, a.data());
	again.render(&episode, {0.3, 0.002, 2}, b.data());
	other.render(&episode, {0.3, 0.002, 2}, c.data());
	EXPECT_EQ(a, b); // whatever was drawn before
	EXPECT_NE(a, c);
}

TEST(SimulatePeople, MoveOtherwiseInEveryWorld)
{
	const sim::People people(2, 5), same(2, 5), others(2, 6);
	const auto elbow = [](const sim::People &crowd, double time) { return crowd.limbs_at(time)[9].to; };
	ASSERT_EQ(people.limbs_at(0.3).size(), 22u);
	EXPECT_EQ(elbow(people, 0.3), elbow(same, 0.3));
	EXPECT_NE(elbow(people, 0.3), elbow(others, 0.3));
	EXPECT_NE(elbow(people, 0.3), elbow(people, 0.4));
	for (const sim::Limb &limb : people.limbs_at(0.3))
		EXPECT_GE(limb.z, sim::people_z);
}

TEST(SimulateSensor, NoiseIsThatOfElectrons)
{
	const sim::Sensor sensor({}, 1);
	for (const double level : {40.0, 100.0, 230.0}) {
		const std::vector<sim::Fixed> light(640, sim::Sensor::light(level));
		const std::vector<sim::Fixed> deviation(640, sensor.deviation(light[0]));
		std::vector<uint8_t> row(640);
		double sum = 0, squares = 0;
		const int rows = 400;
		for (uint64_t key = 0; key < rows; key++) {
			sensor.expose(light.data(), deviation.data(), 640, key * 7919, row.data());
			for (const uint8_t pixel : row) {
				sum += pixel - level;
				squares += (pixel - level) * (pixel - level);
			}
		}
		const double count = 640.0 * rows, gain = 20000 / 255.0, mean = sum / count;
		const double variance = (level * gain + 16 * 16) / (gain * gain) + 1.0 / 12;
		EXPECT_NEAR(mean, 0, 0.03);
		EXPECT_NEAR(squares / count - mean * mean, variance, 0.03 * variance);
	}
}

TEST(SimulateSensor, NoiseFollowsItsKey)
{
	const sim::Sensor sensor({}, 1);
	const std::vector<sim::Fixed> light(640, sim::Sensor::light(100)), deviation(640, 1024);
	std::vector<uint8_t> a(640), b(640), c(640);
	sensor.expose(light.data(), deviation.data(), 640, 1, a.data());
	sensor.expose(light.data(), deviation.data(), 640, 1, b.data());
	sensor.expose(light.data(), deviation.data(), 640, 2, c.data());
	EXPECT_EQ(a, b);
	EXPECT_NE(a, c);
}

TEST(SimulateSensor, SaturatesAtWhiteAndBlack)
{
	const sim::Sensor sensor({}, 1);
	std::vector<uint8_t> row(64);
	for (const double level : {0.0, 300.0}) {
		const std::vector<sim::Fixed> light(64, sim::Sensor::light(level)), deviation(64, 20000);
		sensor.expose(light.data(), deviation.data(), 64, 3, row.data());
		EXPECT_GT(std::count(row.begin(), row.end(), level > 0 ? 255 : 0), 10);
	}
}

} // namespace
