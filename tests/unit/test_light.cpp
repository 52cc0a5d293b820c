// The light on a ball, seen by two cameras.
#include <cmath>
#include <gtest/gtest.h>

#include "light.hpp"
#include "rigs.hpp"

namespace
{

// The polynomial of sphere.hpp at a normal.
double shade(const Eigen::Matrix<double, 9, 1> &term, const Eigen::Vector3d &n)
{
	return term[0] + term[1] * n.x() + term[2] * n.y() + term[3] * n.z() + term[4] * n.x() * n.y() +
	       term[5] * n.x() * n.z() + term[6] * n.y() * n.z() + term[7] * n.x() * n.x() + term[8] * n.y() * n.y();
}

TEST(Light, TurnsWithTheNormals)
{
	const Eigen::Matrix3d turn =
		Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
	const pong::LightMatrix matrix = pong::turn_light(turn);
	srand(1);
	for (int i = 0; i < 20; i++) {
		const Eigen::Matrix<double, 9, 1> term = Eigen::Matrix<double, 9, 1>::Random();
		const Eigen::Vector3d normal = Eigen::Vector3d::Random().normalized();
		EXPECT_NEAR(shade(matrix * term, turn * normal), shade(term, normal), 1e-12);
	}
}

const double place[3] = {0.15, 0.25, 1.4};

// A centre whose light is known to 10 grey levels in one term, and with it u to 0.2 px, and to 0.02 px by itself.
// Everything errs by `light_error` standard deviations of the first.
pong_centre centre_by_light(const pong_camera &camera, double light_error)
{
	pong_centre centre = {};
	double uv[2];
	pong_project(&camera, place, uv);
	const float level = 10, along_u = 0.2f;
	centre.u = uv[0] + static_cast<double>(along_u) * light_error;
	centre.v = uv[1];
	centre.radius = pong_apparent_size(&camera, place, 0.040) / 2;
	centre.covariance[0][0] = 0.02 * 0.02 + 0.2 * 0.2;
	centre.covariance[1][1] = 0.02 * 0.02;
	centre.common = 0.5;
	centre.light.known = 1;
	for (int i = 0; i < PONG_LIGHT_TERMS; i++)
		centre.light.covariance[i][i] = 0.01f;
	centre.light.term[0] = 100;
	centre.light.term[1] = 30 + level * static_cast<float>(light_error);
	centre.light.term[PONG_LIGHT_TERMS - 1] = static_cast<float>(centre.radius);
	centre.light.covariance[1][1] = level * level;
	centre.light.with_centre[0][1] = level * along_u;
	return centre;
}

double depth_error(pong_centre left, pong_centre right, bool light_known, double *deviation)
{
	const pong_rig rig = test_rig();
	pong_settings settings;
	pong_settings_defaults(PONG_BEST, &settings);
	left.light.known = light_known;
	pong_point point = {};
	EXPECT_EQ(pong_reconstruct(&rig, &left, &right, &settings, &point), PONG_FOUND);
	*deviation = std::sqrt(point.covariance[2][2]);
	return std::abs(point.position[2] - place[2]);
}

TEST(Light, IsOneForBothPictures)
{
	const pong_rig rig = test_rig();
	const pong_centre left = centre_by_light(rig.camera[PONG_LEFT], 1);
	const pong_centre right = centre_by_light(rig.camera[PONG_RIGHT], -0.5);
	double apart_deviation, joined_deviation;
	const double apart = depth_error(left, right, false, &apart_deviation);
	const double joined = depth_error(left, right, true, &joined_deviation);
	EXPECT_GT(apart, 0.003);
	EXPECT_LT(joined, 0.2 * apart);
	EXPECT_LT(joined_deviation, 0.5 * apart_deviation);
}

// Something other than light makes pictures of a ball so unlike.
TEST(Light, IsTrustedLessWhereItIsUnlike)
{
	const pong_rig rig = test_rig();
	const pong_centre left = centre_by_light(rig.camera[PONG_LEFT], 1);
	pong_centre right = centre_by_light(rig.camera[PONG_RIGHT], -0.5);
	double alike_deviation, unlike_deviation;
	depth_error(left, right, true, &alike_deviation);
	right.light.term[5] += 30;
	depth_error(left, right, true, &unlike_deviation);
	EXPECT_GT(unlike_deviation, 1.5 * alike_deviation);
}

} // namespace
