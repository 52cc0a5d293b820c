// Centres of drawn and of lit balls, by every method.
#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "cone.hpp"
#include "pictures.hpp"
#include "rigs.hpp"

namespace
{

// Ambient light, and along the normal's x, y, -z. Under the first, the outline is brighter than the background above,
// darker below, and neither in between: hard for edges. Under the second it is brighter all around.
const double hard_shades[4] = {0.35, 0.1, -0.25, 0.4};
const double even_shades[4] = {0.6, 0.05, -0.1, 0.2};

// A sphere of the table frame seen by a camera: each pixel's brightness from 8 x 8 rays, by ray and sphere alone.
std::vector<uint8_t> render(const pong_camera &camera, const Eigen::Vector3d &centre, double radius,
			    const double *shades, unsigned seed)
{
	const int fine = 8;
	const pong::Camera parts(camera);
	std::mt19937 random(seed);
	std::normal_distribution<double> noise(0, 1);
	std::vector<uint8_t> pixels;
	const Eigen::Vector3d to_centre = centre - parts.centre;
	for (int v = 0; v < camera.height; v++)
		for (int u = 0; u < camera.width; u++) {
			double sum = 0;
			const double far = (Eigen::Vector2d(u, v) - parts.project(centre)).norm();
			const int samples = far < 60 ? fine : 1;
			for (int k = 0; k < samples * samples; k++) {
				const Eigen::Vector2d pixel(u - 0.5 + (k % samples + 0.5) / samples,
							    v - 0.5 + (k / samples + 0.5) / samples);
				const Eigen::Vector3d ray = parts.ray(pixel);
				const double along = ray.dot(to_centre);
				const double inside = radius * radius - to_centre.squaredNorm() + along * along;
				double level = 50 + 0.02 * u;
				if (inside > 0) {
					const Eigen::Vector3d normal =
						parts.R * ((along - std::sqrt(inside)) * ray - to_centre) / radius;
					level = 200 * (shades[0] + shades[1] * normal.x() + shades[2] * normal.y() -
						       shades[3] * normal.z());
				}
				sum += level;
			}
			pixels.push_back(static_cast<uint8_t>(
				std::clamp(std::lround(sum / (samples * samples) + noise(random)), 0l, 255l)));
		}
	return pixels;
}

struct Sight {
	pong_camera camera;
	std::vector<uint8_t> current, earlier;
	pong_detection detection;
	double uv[2];

	Sight(pong_side side, const Eigen::Vector3d &place, const double *shades = hard_shades)
		: camera(test_rig().camera[side])
	{
		current = render(camera, place, 0.020, shades, 1);
		earlier = render(camera, Eigen::Vector3d(0, 5, 1), 0.001, shades, 2);
		pong_project(&camera, place.data(), uv);
		detection = {uv[0] + 0.6, uv[1] - 0.5, pong_apparent_size(&camera, place.data(), 0.040) * 1.05, 60};
	}

	// Cut the first columns off both pictures: a camera with its principal point farther left.
	void crop_left(int columns)
	{
		const auto crop = [&](std::vector<uint8_t> &pixels) {
			std::vector<uint8_t> rest;
			for (int v = 0; v < camera.height; v++)
				rest.insert(rest.end(), pixels.begin() + v * camera.width + columns,
					    pixels.begin() + (v + 1) * camera.width);
			pixels = rest;
		};
		crop(current);
		crop(earlier);
		camera.width -= columns;
		for (int i = 0; i < 4; i++)
			camera.P[0][i] -= columns * camera.P[2][i];
		uv[0] -= columns;
		detection.u -= columns;
	}

	// What covers may have been there before the ball came.
	void cover_below(int row, uint8_t level, bool before)
	{
		std::fill(current.begin() + row * camera.width, current.end(), level);
		if (before)
			std::fill(earlier.begin() + row * camera.width, earlier.end(), level);
	}

	// The centre's distance from where it is, px; 99 where there is none.
	double error(pong_locate_method method, pong_centre *centre) const
	{
		pong_settings settings;
		pong_settings_defaults(PONG_BEST, &settings);
		settings.locate.method = method;
		const auto image = [&](const std::vector<uint8_t> &pixels) {
			return pong_image{pixels.data(), camera.width, camera.height, camera.width};
		};
		const pong_pictures pictures = {image(current), {image(earlier), image(earlier)}};
		if (!pong_locate(&camera, &pictures, &detection, nullptr, &settings, centre))
			return 99;
		return std::hypot(centre->u - uv[0], centre->v - uv[1]);
	}
};

TEST(Locate, FollowsShadedBallsByEveryMethod)
{
	const Sight sight(PONG_LEFT, {0.2, 0.25, 1.5});
	pong_centre centre;
	EXPECT_LT(sight.error(PONG_LOCATE_GAUSSIAN, &centre), 6);
	EXPECT_LT(sight.error(PONG_LOCATE_CENTROID, &centre), 1);
	EXPECT_LT(sight.error(PONG_LOCATE_PHOTOMETRIC, &centre), 0.05);
}

// Where all of the outline is brighter than the background, edges see it to a tenth of a pixel.
TEST(Locate, FindsTheOutlineByItsEdges)
{
	for (const double x : {-0.1, 0.0, 0.1})
		for (const double z : {0.8, 1.5, 2.2}) {
			const Sight sight(PONG_LEFT, {x, 0.25, z}, even_shades);
			pong_centre centre;
			EXPECT_LT(sight.error(PONG_LOCATE_EDGES, &centre), 0.1) << x << " " << z;
			EXPECT_EQ(centre.flags, 0u);
		}
}

// The light is the same for both cameras.
TEST(Locate, TellsTheLightInTheTableFrame)
{
	for (const pong_side side : {PONG_LEFT, PONG_RIGHT}) {
		const Sight sight(side, {0.15, 0.25, 1.0}, even_shades);
		pong_centre centre;
		ASSERT_LT(sight.error(PONG_LOCATE_PHOTOMETRIC, &centre), 0.05);
		ASSERT_TRUE(centre.light.known);
		const Eigen::Vector3d rise(even_shades[1], even_shades[2], -even_shades[3]);
		const Eigen::Vector3d expected = 200 * pong::Camera(sight.camera).R.transpose() * rise;
		for (int axis = 0; axis < 3; axis++) {
			const int term = 1 + axis;
			EXPECT_NEAR(static_cast<double>(centre.light.term[term]), expected[axis],
				    4 * std::sqrt(static_cast<double>(centre.light.covariance[term][term])));
		}
	}
}

// A lamp that flickers, or a shadow, changes what is behind the ball.
TEST(Locate, BearsOtherLightBehindTheBall)
{
	Sight sight(PONG_LEFT, {0.1, 0.25, 1.5}, even_shades);
	for (uint8_t &pixel : sight.earlier)
		pixel = static_cast<uint8_t>(0.9 * pixel);
	pong_centre centre;
	EXPECT_LT(sight.error(PONG_LOCATE_PHOTOMETRIC, &centre), 0.05);
}

// The left part of the ball is out of the picture.
TEST(Locate, FlagsWhatTheBorderCuts)
{
	Sight sight(PONG_LEFT, {0.1, 0.25, 1.0}, even_shades);
	pong_centre whole, cut;
	ASSERT_LT(sight.error(PONG_LOCATE_PHOTOMETRIC, &whole), 0.05);
	EXPECT_EQ(whole.flags, 0u);
	sight.crop_left(static_cast<int>(sight.uv[0] - 0.6 * whole.radius));
	ASSERT_LT(sight.error(PONG_LOCATE_PHOTOMETRIC, &cut), 0.3);
	EXPECT_EQ(cut.flags, static_cast<unsigned>(PONG_CENTRE_CUT));
	EXPECT_GT(cut.covariance[0][0], whole.covariance[0][0]);
}

// A racket of one brightness hides the lower part of the ball: one that comes with it, and one that rests.
TEST(Locate, FlagsWhatIsCovered)
{
	for (const bool before : {false, true}) {
		Sight sight(PONG_LEFT, {0.1, 0.25, 1.0}, even_shades);
		pong_centre whole, covered;
		ASSERT_LT(sight.error(PONG_LOCATE_PHOTOMETRIC, &whole), 0.05);
		sight.cover_below(static_cast<int>(sight.uv[1] + 0.6 * whole.radius), 20, before);
		ASSERT_LT(sight.error(PONG_LOCATE_PHOTOMETRIC, &covered), 1);
		EXPECT_EQ(covered.flags, static_cast<unsigned>(PONG_CENTRE_COVERED));
		EXPECT_GT(covered.covariance[1][1], 2 * whole.covariance[1][1]);
	}
}

// Off the axis and close, the outline is an ellipse whose middle is not the ball's centre.
TEST(Locate, FindsTheSphereNotItsOutline)
{
	const Sight sight(PONG_RIGHT, {0.12, 0.15, 0.7});
	pong_centre centre;
	EXPECT_LT(sight.error(PONG_LOCATE_PHOTOMETRIC, &centre), 0.05);
	EXPECT_NEAR(2 * centre.radius, sight.detection.size / 1.05, 0.3);
}

// The error is what the covariance says that it is: not a tenth, nor ten times.
TEST(Locate, TellsItsUncertainty)
{
	double sum = 0;
	int count = 0;
	for (const double x : {-0.1, 0.0, 0.1})
		for (const double z : {1.0, 1.8}) {
			const Sight sight(PONG_LEFT, {x, 0.2, z});
			pong_centre centre;
			ASSERT_LT(sight.error(PONG_LOCATE_PHOTOMETRIC, &centre), 1);
			const Eigen::Vector2d error(centre.u - sight.uv[0], centre.v - sight.uv[1]);
			const Eigen::Matrix2d covariance = Eigen::Map<Eigen::Matrix2d>(&centre.covariance[0][0]);
			EXPECT_GT(covariance.determinant(), 0);
			sum += error.dot(covariance.inverse() * error);
			count++;
		}
	EXPECT_LT(sum / count, 6);
}

TEST(Locate, SaysWhereNothingIs)
{
	const Sight sight(PONG_LEFT, {0, 5, 1}); // out of the picture
	pong_centre centre;
	Sight empty = sight;
	empty.detection = {300, 200, 20, 60};
	empty.uv[0] = 300;
	empty.uv[1] = 200;
	EXPECT_EQ(empty.error(PONG_LOCATE_EDGES, &centre), 99);
	EXPECT_EQ(empty.error(PONG_LOCATE_PHOTOMETRIC, &centre), 99);
}

// Points on the true outline of a sphere give its centre back, with a wild one among them.
TEST(Cone, GoesThroughTheOutline)
{
	const pong_camera camera = test_rig().camera[PONG_LEFT];
	const pong::Camera parts(camera);
	const Eigen::Vector3d centre(0.25, 0.2, 1.0), axis = (centre - parts.centre).normalized();
	const double sine = 0.020 / (centre - parts.centre).norm();
	const Eigen::Vector3d across = axis.unitOrthogonal(), other = axis.cross(across);
	pong::EdgePoint points[24];
	for (int i = 0; i < 24; i++) {
		const double angle = 2 * M_PI * i / 24;
		const Eigen::Vector3d ray =
			std::sqrt(1 - sine * sine) * axis + sine * (std::cos(angle) * across + std::sin(angle) * other);
		points[i] = {parts.project(parts.centre + ray), 0.1};
	}
	points[5].pixel += 0.2 * (points[5].pixel - parts.project(centre));
	pong::ConeFit fit;
	ASSERT_TRUE(pong::fit_cone(parts, points, 24, &fit));
	EXPECT_LT((fit.centre - parts.project(centre)).norm(), 1e-6);
	EXPECT_EQ(fit.used, 23);
}

TEST(Streak, IsTheWayOfThePicture)
{
	const pong_rig rig = test_rig();
	const double position[3] = {0, 0.3, 1.5}, velocity[3] = {10, 0, 0};
	double streak[3];
	ASSERT_EQ(pong_streak(&rig.camera[PONG_LEFT], position, velocity, 0.002, streak), PONG_FOUND);
	const double size = pong_apparent_size(&rig.camera[PONG_LEFT], position, 0.020);
	EXPECT_NEAR(streak[0], -size, 1e-3); // 20 mm to the robot's left are to the left in the picture
	EXPECT_NEAR(streak[1], 0, 1e-3);
	const double coming[3] = {0, 0, -10};
	ASSERT_EQ(pong_streak(&rig.camera[PONG_LEFT], position, coming, 0.002, streak), PONG_FOUND);
	EXPECT_NEAR(streak[2], 0.020 / (1.5 + 0.4), 1e-3); // it comes 20 mm nearer, 1.9 m before the camera
}

// A ball that flies across: what it moved since it was seen tells the same as its velocity.
TEST(Streak, OfABallThatWasSeenOnce)
{
	const pong_rig rig = test_rig();
	const pong_camera &camera = rig.camera[PONG_LEFT];
	const double before[3] = {0.1, 0.2, 1.5}, velocity[3] = {6, 2, 0}, seconds = 0.009;
	double now[3], uv[2], expected[3], streak[3];
	for (int axis = 0; axis < 3; axis++)
		now[axis] = before[axis] + seconds * velocity[axis];
	ASSERT_TRUE(pong_project(&camera, now, uv));
	const pong_detection found = {uv[0], uv[1], pong_apparent_size(&camera, now, rig.ball.diameter), 60};
	ASSERT_EQ(pong_streak(&camera, now, velocity, 0.002, expected), PONG_FOUND);
	ASSERT_EQ(pong_streak_since(&camera, before, seconds, &found, 0.002, streak), PONG_FOUND);
	EXPECT_NEAR(streak[0], expected[0], 0.05);
	EXPECT_NEAR(streak[1], expected[1], 0.05);
	EXPECT_EQ(pong_streak_since(&camera, before, 0, &found, 0.002, streak), PONG_NONE);
	pong_detection another = found;
	another.u += 20 * found.size;
	EXPECT_EQ(pong_streak_since(&camera, before, seconds, &another, 0.002, streak), PONG_NONE);
}

} // namespace
