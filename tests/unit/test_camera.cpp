// Projection, lens and rays of a camera.
#include <cmath>
#include <gtest/gtest.h>

#include "rigs.hpp"

namespace
{

// A point projected by hand: f X / Z + c along the camera's own axes.
TEST(Camera, ProjectsAsAPinholeDoes)
{
	const pong_rig rig = test_rig();
	const double position[3] = {-0.10, 0.30, 1.60}; // 0.19 m right of the left camera, 0.2 m below it, 2 m ahead
	const double pitch = 13 * M_PI / 180;
	const double depth = 2 * std::cos(pitch) + 0.2 * std::sin(pitch);
	const double down = 0.2 * std::cos(pitch) - 2 * std::sin(pitch);
	double uv[2];
	ASSERT_EQ(pong_project(&rig.camera[PONG_LEFT], position, uv), PONG_FOUND);
	EXPECT_NEAR(uv[0], 1081 * 0.19 / depth + 319.5, 1e-9);
	EXPECT_NEAR(uv[1], 1081 * down / depth + 239.5, 1e-9);
	EXPECT_NEAR(pong_apparent_size(&rig.camera[PONG_LEFT], position, 0.040), 1081 * 0.040 / depth, 1e-9);
}

TEST(Camera, SeesNothingBehindIt)
{
	const pong_rig rig = test_rig();
	const double behind[3] = {0, 0.5, -1};
	double uv[2];
	EXPECT_EQ(pong_project(&rig.camera[PONG_LEFT], behind, uv), PONG_NONE);
	EXPECT_EQ(pong_apparent_size(&rig.camera[PONG_LEFT], behind, 0.040), 0);
}

TEST(Camera, RayMeetsThePointItSees)
{
	pong_rig rig = test_rig();
	const double distortion[5] = {-0.4, 0.3, 0.002, -0.003, 0.05};
	std::copy_n(distortion, 5, rig.camera[PONG_RIGHT].distortion);
	const double position[3] = {0.3, 0.2, 2.0};
	double uv[2], centre[3], direction[3];
	ASSERT_EQ(pong_project(&rig.camera[PONG_RIGHT], position, uv), PONG_FOUND);
	pong_ray(&rig.camera[PONG_RIGHT], uv, centre, direction);
	const double distance = std::hypot(position[0] - centre[0], position[1] - centre[1], position[2] - centre[2]);
	for (int axis = 0; axis < 3; axis++)
		EXPECT_NEAR(centre[axis] + distance * direction[axis], position[axis], 1e-9);
	EXPECT_NEAR(centre[0], -0.09, 1e-12);
}

// Undistortion against the definition: distort an ideal pixel by Brown's formula, written out here.
TEST(Camera, UndistortInvertsTheLens)
{
	pong_camera camera = test_rig().camera[PONG_LEFT];
	const double k1 = -0.25, k2 = 0.1, p1 = 0.001, p2 = -0.002, k3 = 0.03;
	const double distortion[5] = {k1, k2, p1, p2, k3};
	std::copy_n(distortion, 5, camera.distortion);
	for (double v = 0; v < 480; v += 60)
		for (double u = 0; u < 640; u += 80) {
			const double x = (u - 319.5) / 1081, y = (v - 239.5) / 1081, r2 = x * x + y * y;
			const double radial = 1 + k1 * r2 + k2 * r2 * r2 + k3 * r2 * r2 * r2;
			const double seen[2] = {319.5 + 1081 * (x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)),
						239.5 + 1081 * (y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y)};
			double ideal[2];
			pong_undistort(&camera, seen, ideal);
			EXPECT_NEAR(ideal[0], u, 1e-8);
			EXPECT_NEAR(ideal[1], v, 1e-8);
		}
}

} // namespace
