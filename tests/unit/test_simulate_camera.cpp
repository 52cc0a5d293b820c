#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include <Eigen/Geometry>

#include "tools/simulate/camera.hpp"

namespace
{

using Eigen::Vector2d;
using Eigen::Vector3d;

const std::array<double, 5> lens = {-0.15, 0.05, 0.001, -0.002, 0.01};

sim::Rig rig_with(const std::array<double, 5> &distortion)
{
	sim::RigSettings settings;
	settings.distortion = distortion;
	return sim::make_rig(settings);
}

void expect_seen(const sim::Camera &camera, const Vector3d &point, double u, double v)
{
	Vector2d uv;
	ASSERT_TRUE(camera.project(point, &uv));
	EXPECT_NEAR(uv.x(), u, 1e-5);
	EXPECT_NEAR(uv.y(), v, 1e-5);
}

// Expected pixels come from a few lines of numpy that write the pinhole and OpenCV's lens model out.
TEST(SimulateCamera, ProjectsLikeAPinhole)
{
	const sim::Rig rig = rig_with({});
	expect_seen(rig[0], {0, 0.02, 1.65}, 365.712441, 242.862196);
	expect_seen(rig[1], {0, 0.02, 1.65}, 273.287559, 242.862196);
	expect_seen(rig[0], {0.3, 0.42, 2.6}, 242.308969, 20.092375);
	expect_seen(rig[1], {-0.2, 0.1, 1.0}, 401.281886, 295.123987);
}

TEST(SimulateCamera, DistortsLikeOpenCV)
{
	const sim::Rig rig = rig_with(lens);
	expect_seen(rig[0], {0, 0.02, 1.65}, 365.688129, 242.862702);
	expect_seen(rig[1], {0.3, 0.42, 2.6}, 177.239062, 22.024546);
	expect_seen(rig[0], {-0.2, 0.1, 1.0}, 533.512844, 294.782293);
}

// What lies to the robot's right is right in the picture; what the left camera sees is farther right than in the right.
TEST(SimulateCamera, LooksAlongTheTable)
{
	const sim::Rig rig = rig_with({});
	Vector2d left, right, aside;
	ASSERT_TRUE(rig[0].project({0, 0.1, 2}, &left));
	ASSERT_TRUE(rig[1].project({0, 0.1, 2}, &right));
	ASSERT_TRUE(rig[0].project({-0.1, 0.1, 2}, &aside));
	EXPECT_GT(left.x(), right.x());
	EXPECT_GT(aside.x(), left.x());
	EXPECT_NEAR(left.y(), right.y(), 1e-9);
	const double depth = rig[0].to_camera({0, 0.1, 2}).z();
	EXPECT_NEAR(left.x() - right.x(), 8 / 0.0074 * 0.18 / depth, 1e-9);
}

TEST(SimulateCamera, SeesNothingBehindItself)
{
	Vector2d uv;
	EXPECT_FALSE(rig_with({})[0].project({0, 0.5, -1}, &uv));
}

// Far off the axis the polynomial turns back: such points must not show up in the picture.
TEST(SimulateCamera, SeesNothingBeyondTheLens)
{
	const sim::Camera camera = rig_with({-0.4, 0, 0, 0, 0})[0];
	Vector2d uv;
	EXPECT_FALSE(camera.project(camera.centre + camera.R_cam_table.transpose() * Vector3d(1.4, 0, 1), &uv));
}

TEST(SimulateCamera, UndistortsWhatItDistorts)
{
	for (double x = -0.35; x <= 0.35; x += 0.07)
		for (double y = -0.3; y <= 0.3; y += 0.06) {
			Vector2d distorted;
			ASSERT_TRUE(sim::distort(lens, {x, y}, &distorted));
			EXPECT_LT((sim::undistort(lens, distorted) - Vector2d(x, y)).norm(), 1e-12);
		}
}

TEST(SimulateCamera, ProjectionGivesDepthInMetres)
{
	const sim::Camera camera = rig_with({})[1];
	const Vector3d point(0.3, 0.42, 2.6);
	const Vector3d image = camera.projection() * point.homogeneous();
	EXPECT_NEAR(image.z(), camera.to_camera(point).z(), 1e-12);
	expect_seen(camera, point, image.x() / image.z(), image.y() / image.z());
}

TEST(SimulateCamera, RigTextHoldsEveryDigit)
{
	const sim::Rig rig = rig_with(lens);
	const std::string text = sim::rig_text(rig, 0.25);
	EXPECT_NE(text.find("[hit]\nz = 0.25\n"), std::string::npos);
	EXPECT_NE(text.find("size = [640, 480]"), std::string::npos);
	const char *cursor = text.c_str() + text.find("P = [", text.find("[right]")) + 5;
	for (int row = 0; row < 3; row++)
		for (int column = 0; column < 4; column++) {
			char *end;
			EXPECT_EQ(strtod(cursor, &end), rig[1].projection()(row, column));
			cursor = end + 1;
		}
	EXPECT_NE(text.find("distortion = [-0.14999999999999999, "), std::string::npos);
}

} // namespace
