// From two centres to a point: geometry, the likely point, its covariance, the gates.
#include <Eigen/Dense>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "rigs.hpp"

namespace
{

const double place[3] = {0.15, 0.25, 1.4};

pong_centre centre_of(const pong_camera &camera, const double position[3], double su, double sv)
{
	double uv[2];
	pong_project(&camera, position, uv);
	return {uv[0], uv[1], pong_apparent_size(&camera, position, 0.040) / 2, {{su * su, 0}, {0, sv * sv}}, 0, 0, {}};
}

TEST(Reconstruct, TriangulatesWhatIsProjected)
{
	const pong_rig rig = test_rig();
	double left[2], right[2], point[3];
	pong_project(&rig.camera[PONG_LEFT], place, left);
	pong_project(&rig.camera[PONG_RIGHT], place, right);
	ASSERT_EQ(pong_triangulate(rig.camera, left, right, point), PONG_FOUND);
	for (int axis = 0; axis < 3; axis++)
		EXPECT_NEAR(point[axis], place[axis], 1e-9);
	EXPECT_NEAR(pong_epipolar_distance(rig.camera, left, right), 0, 1e-9);
	right[1] += 2;
	EXPECT_NEAR(pong_epipolar_distance(rig.camera, left, right), 2, 1e-6);
}

// Normalised error squared averages 3, when the centres are as uncertain as they say, and as alike in what they err.
void expect_true_covariance(double common)
{
	const pong_rig rig = test_rig();
	pong_settings settings;
	pong_settings_defaults(PONG_BEST, &settings);
	std::mt19937 random(4);
	std::normal_distribution<double> normal(0, 1);
	const double sigma[2][2] = {{0.05, 0.2}, {0.1, 0.03}};
	double sum = 0;
	const int trials = 2000;
	for (int i = 0; i < trials; i++) {
		pong_centre centre[2];
		const double both[2] = {normal(random), normal(random)};
		for (int side = 0; side < 2; side++) {
			centre[side] = centre_of(rig.camera[side], place, sigma[side][0], sigma[side][1]);
			const auto error = [&](int axis) {
				return sigma[side][axis] *
				       (std::sqrt(common) * both[axis] + std::sqrt(1 - common) * normal(random));
			};
			centre[side].u += error(0);
			centre[side].v += error(1);
			centre[side].common = common;
		}
		pong_point point;
		ASSERT_EQ(pong_reconstruct(&rig, &centre[0], &centre[1], &settings, &point), PONG_FOUND);
		const Eigen::Vector3d error =
			Eigen::Map<Eigen::Vector3d>(point.position) - Eigen::Map<const Eigen::Vector3d>(place);
		sum += error.dot(Eigen::Map<Eigen::Matrix3d>(&point.covariance[0][0]).inverse() * error);
	}
	EXPECT_NEAR(sum / trials, 3, 0.2);
}

TEST(Reconstruct, CovarianceIsTrue)
{
	expect_true_covariance(0);
	expect_true_covariance(0.5);
}

// Where u of a centre errs with v, a rig that puts the centres 0.7 px off each other's epipolar lines must not move the
// point in depth.
TEST(Reconstruct, WhatTheRigErrsAcrossTheEpipolarLinesMovesNoDepth)
{
	const pong_rig rig = test_rig();
	pong_settings settings;
	pong_settings_defaults(PONG_BEST, &settings);
	double depth[2];
	for (int tilted = 0; tilted < 2; tilted++) {
		pong_centre centre[2];
		for (int side = 0; side < 2; side++) {
			centre[side] = centre_of(rig.camera[side], place, 0.05, 0.05);
			const double with = tilted ? 0.8 * 0.05 * 0.05 : 0;
			centre[side].covariance[0][1] = centre[side].covariance[1][0] = with;
		}
		centre[PONG_RIGHT].v += 0.7;
		pong_point point;
		ASSERT_EQ(pong_reconstruct(&rig, &centre[0], &centre[1], &settings, &point), PONG_FOUND);
		depth[tilted] = point.position[2];
	}
	EXPECT_NEAR(depth[1], depth[0], 1e-4);
}

TEST(Reconstruct, RefusesWhatIsNotOneBall)
{
	const pong_rig rig = test_rig();
	pong_settings settings;
	pong_settings_defaults(PONG_BEST, &settings);
	const pong_centre left = centre_of(rig.camera[PONG_LEFT], place, 0.1, 0.1);
	pong_centre right = centre_of(rig.camera[PONG_RIGHT], place, 0.1, 0.1);
	pong_point point;
	EXPECT_EQ(pong_reconstruct(&rig, &left, &right, &settings, &point), PONG_FOUND);
	right.v += 10;
	EXPECT_EQ(pong_reconstruct(&rig, &left, &right, &settings, &point), PONG_NONE);
	right.v -= 10;
	right.radius *= 2;
	EXPECT_EQ(pong_reconstruct(&rig, &left, &right, &settings, &point), PONG_NONE);
}

} // namespace
