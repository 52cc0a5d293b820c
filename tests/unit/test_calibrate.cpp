// Calibration against simulated corners, whose projection is the simulator's own.
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>

#include "tools/bench/boards.hpp"

namespace
{

using pong::Recording;
using pong::Session;

pong_calibrate_settings settings_of(pong_profile profile)
{
	pong_calibrate_settings settings;
	pong_calibrate_defaults(profile, &settings);
	for (int side = 0; side < 2; side++) {
		settings.width[side] = pong::true_width;
		settings.height[side] = pong::true_height;
	}
	return settings;
}

int calibrate(const Recording &recording, const pong_calibrate_settings &settings, pong_calibration *calibration,
	      pong_error *error = nullptr)
{
	return pong_calibrate(recording.views.data(), static_cast<int>(recording.views.size()),
			      recording.corners.data(), static_cast<int>(recording.corners.size()), &settings,
			      calibration, nullptr, nullptr, error);
}

// 32 pairs: four planes, and a board of A3 size held at will.
Session session_of_32(double placement, double tilt)
{
	Session session;
	session.placement = placement;
	session.tilt = tilt;
	session.boards = 28;
	session.shape.square = 0.040;
	return session;
}

struct Outcome {
	double mean, actual, expected; // m: mean error, its rms, the rms that was expected
};

Outcome run(const Session &session, double k1, int seeds)
{
	const pong::TrueRig rig = pong::true_rig(k1);
	Outcome outcome = {};
	for (int seed = 1; seed <= seeds; seed++) {
		std::mt19937_64 random(static_cast<uint64_t>(seed));
		pong_calibration calibration;
		EXPECT_EQ(calibrate(record(rig, session, random), settings_of(PONG_BEST), &calibration), PONG_FOUND);
		const pong::VolumeError error = volume_error(rig, calibration.camera, pong::table_volume());
		outcome.mean += error.mean / seeds;
		outcome.actual += error.rms * error.rms / seeds;
		outcome.expected += std::pow(pong::expected_error(calibration, pong::table_volume()), 2) / seeds;
	}
	outcome.actual = std::sqrt(outcome.actual);
	outcome.expected = std::sqrt(outcome.expected);
	printf("# mean 3-D error %.3f mm, rms %.3f mm, expected %.3f mm, ratio %.3f\n", 1e3 * outcome.mean,
	       1e3 * outcome.actual, 1e3 * outcome.expected, outcome.expected / outcome.actual);
	return outcome;
}

TEST(Calibrate, FindsThePerfectRigExactly)
{
	Session session = session_of_32(0, 0);
	session.noise = 0;
	session.boards = 6;
	EXPECT_LT(run(session, -0.15, 1).mean, 1e-6);
}

TEST(Calibrate, IsGoodToATableAndKnowsHowGood)
{
	const Outcome outcome = run(session_of_32(0.0002, 0.001), -0.15, 50);
	EXPECT_LE(outcome.mean, 0.0008);
	EXPECT_GE(outcome.expected / outcome.actual, 0.8);
	EXPECT_LE(outcome.expected / outcome.actual, 1.25);
}

TEST(Calibrate, IsBetterWithPlanesPlacedExactly)
{
	EXPECT_LE(run(session_of_32(0, 0), -0.15, 10).mean, 0.0006);
}

TEST(Calibrate, ThePapersMethodIsExactForAPerfectLensOnly)
{
	Session session;
	session.boards = 0;
	double off[2];
	for (const int distorted : {0, 1}) {
		const pong::TrueRig rig = pong::true_rig(distorted ? -0.15 : 0);
		std::mt19937_64 random(1);
		pong_calibration calibration;
		ASSERT_EQ(calibrate(record(rig, session, random), settings_of(PONG_PAPER), &calibration), PONG_FOUND);
		off[distorted] = volume_error(rig, calibration.camera, pong::table_volume()).mean;
		EXPECT_TRUE(std::isnan(calibration.covariance[0][0]));
	}
	EXPECT_LT(off[0], 0.002);
	EXPECT_GT(off[1], 0.010);
}

// Boards only: one of them lies where it is said to lie, to a hair.
TEST(Calibrate, WorksWithoutPlanes)
{
	const pong::TrueRig rig = pong::true_rig(-0.15);
	Session session = session_of_32(0, 0);
	session.noise = 0.01;
	session.planes = false;
	std::mt19937_64 random(3);
	Recording recording = record(rig, session, random);
	recording.views[0].placed = 1;
	for (int i = 0; i < 3; i++)
		for (int j = 0; j < 4; j++)
			recording.views[0].pose[i][j] = recording.poses[0](i, j);
	pong_calibration calibration;
	ASSERT_EQ(calibrate(recording, settings_of(PONG_BEST), &calibration), PONG_FOUND);
	EXPECT_LT(volume_error(rig, calibration.camera, pong::table_volume()).mean, 0.001);
}

// Every fiftieth corner is ten pixels off: found all the same.
TEST(Calibrate, BearsOutliers)
{
	const pong::TrueRig rig = pong::true_rig(-0.15);
	std::mt19937_64 random(4);
	Recording recording = record(rig, session_of_32(0, 0), random);
	for (size_t i = 0; i < recording.corners.size(); i += 50)
		recording.corners[i].uv[0] += 10;
	pong_calibration calibration;
	ASSERT_EQ(calibrate(recording, settings_of(PONG_BEST), &calibration), PONG_FOUND);
	EXPECT_LT(volume_error(rig, calibration.camera, pong::table_volume()).mean, 0.001);
}

// A table whose corners both cameras see sets the frame; its stated size is not believed where it is free.
TEST(Calibrate, TakesTheFrameFromPointsOfUncertainPlaces)
{
	const pong::TrueRig rig = pong::true_rig(0);
	Session session = session_of_32(0, 0);
	session.planes = false;
	session.noise = 0.01;
	std::mt19937_64 random(5);
	Recording recording = record(rig, session, random);
	const double stated[4][3] = {{0.3, 0, 0.9}, {-0.3, 0, 0.9}, {-0.7, 0, 2.74}, {0.7, 0, 2.74}};
	pong_view view = {};
	view.placed = 1;
	view.pose[0][0] = view.pose[1][2] = view.pose[2][1] = -1; // as a board that lies on the table
	view.sigma_shape = 1;
	for (const pong_side side : {PONG_LEFT, PONG_RIGHT})
		for (int point = 0; point < 4; point++) {
			const double *p = stated[point];
			Eigen::Vector2d pixel;
			// The true shape is 1 % larger about its middle than stated.
			const Eigen::Vector3d true_place(p[0] * 1.01, p[1], 1.82 + (p[2] - 1.82) * 1.01);
			ASSERT_TRUE(rig.camera[side].see(true_place, pixel));
			recording.corners.push_back({static_cast<int>(recording.views.size()),
						     side,
						     point,
						     {-p[0], -p[2], 0},
						     {pixel.x(), pixel.y()},
						     1});
		}
	recording.views.push_back(view);
	pong_calibration calibration;
	ASSERT_EQ(calibrate(recording, settings_of(PONG_BEST), &calibration), PONG_FOUND);
	EXPECT_LT(volume_error(rig, calibration.camera, pong::table_volume()).mean, 0.001);
}

TEST(Calibrate, OneMoreBoardMakesItMoreCertain)
{
	const pong::TrueRig rig = pong::true_rig(-0.15);
	Session session = session_of_32(0.0002, 0.001);
	session.boards = 5;
	std::mt19937_64 random(6);
	const Recording recording = record(rig, session, random);
	pong_calibration before, after;
	ASSERT_EQ(calibrate(recording, settings_of(PONG_BEST), &before), PONG_FOUND);
	double pose[3][4];
	for (int i = 0; i < 3; i++)
		for (int j = 0; j < 4; j++)
			pose[i][j] = recording.poses[4](i, j);
	std::vector<pong_corner> corners;
	for (const pong_corner &corner : recording.corners)
		if (corner.view == 4)
			corners.push_back(corner);
	pong_calibration_expect(&before, pose, corners.data(), static_cast<int>(corners.size()), &after);
	EXPECT_LT(pong::expected_error(after, pong::table_volume()),
		  pong::expected_error(before, pong::table_volume()));
	EXPECT_GT(pong::expected_error(after, pong::table_volume()),
		  0.5 * pong::expected_error(before, pong::table_volume()));
}

TEST(Calibrate, SaysWhyItCannot)
{
	const pong::TrueRig rig = pong::true_rig(0);
	pong_calibration calibration = {};
	pong_error error;
	Session session;
	session.planes = false;
	std::mt19937_64 random(7);
	Recording recording = record(rig, session, random);
	EXPECT_EQ(calibrate(recording, settings_of(PONG_BEST), &calibration, &error), PONG_ERROR_VALUE);
	EXPECT_STREQ(error.text, "no view is placed: nothing says where the table frame is");
	recording.corners[0].view = 99;
	EXPECT_EQ(calibrate(recording, settings_of(PONG_BEST), &calibration, &error), PONG_ERROR_VALUE);
	EXPECT_STREQ(error.text, "corner 0 is of view 99, but there are 20");
	pong_calibrate_settings settings = settings_of(PONG_BEST);
	settings.width[1] = 0;
	EXPECT_EQ(calibrate(recording, settings, &calibration, &error), PONG_ERROR_VALUE);
	EXPECT_EQ(calibration.rms, 0); // untouched
}

TEST(CalibrationCheck, ScoresTheTruthAtTheNoise)
{
	const pong::TrueRig rig = pong::true_rig(-0.15);
	std::mt19937_64 random(8);
	pong_calibration calibration;
	ASSERT_EQ(calibrate(record(rig, session_of_32(0, 0), random), settings_of(PONG_BEST), &calibration),
		  PONG_FOUND);
	const Recording other = record(rig, session_of_32(0, 0), random);
	double rms;
	ASSERT_EQ(pong_calibration_check(calibration.camera, other.views.data(), static_cast<int>(other.views.size()),
					 other.corners.data(), static_cast<int>(other.corners.size()), &rms, nullptr,
					 nullptr, nullptr),
		  PONG_FOUND);
	EXPECT_NEAR(rms, 0.1 * std::sqrt(2), 0.01);
}

// Balls that fly, bounce and rise, seen by a true rig; the rig that is to be corrected has its right camera turned by
// 0.05 degrees about every axis.
struct Knock {
	pong_rig truth, knocked;
	std::vector<pong_sighting> sightings;
};

pong_camera as_camera(const pong::TrueCamera &camera)
{
	pong_camera result = {};
	result.width = pong::true_width;
	result.height = pong::true_height;
	Eigen::Matrix3d K;
	K << camera.fu, 0, camera.cu, 0, camera.fv, camera.cv, 0, 0, 1;
	Eigen::Matrix<double, 3, 4> P;
	P << K * camera.R, -(K * (camera.R * camera.centre));
	for (int i = 0; i < 3; i++)
		for (int j = 0; j < 4; j++)
			result.P[i][j] = P(i, j);
	return result;
}

Knock knock()
{
	pong::TrueRig rig = pong::true_rig(0);
	Knock result = {};
	for (pong_rig *each : {&result.truth, &result.knocked}) {
		each->ball.diameter = 0.040;
		each->table.present = 1;
		for (int side = 0; side < 2; side++)
			each->camera[side] = as_camera(rig.camera[side]);
	}
	pong::TrueCamera before = rig.camera[PONG_RIGHT];
	const double angle = 0.05 * M_PI / 180;
	before.R = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()) *
		   Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()) *
		   Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) * before.R;
	result.knocked.camera[PONG_RIGHT] = as_camera(before);

	std::mt19937_64 random(9);
	std::normal_distribution<double> noise(0, 0.1);
	for (int flight = 1; flight <= 30; flight++) {
		const double bounce_z = 0.9 + 0.05 * flight, across = 0.02 * (flight % 7 - 3), speed = 4 + 0.1 * flight;
		for (int i = -14; i <= 14; i++) {
			const double t = (i + 0.03 * flight) / 110;
			const double rise = t < 0 ? -2.8 : 2.5; // m/s at the bounce
			const Eigen::Vector3d ball(across, 0.020 + rise * t - 9.81 * t * t / 2, bounce_z - speed * t);
			Eigen::Vector2d pixel[2];
			if (!rig.camera[0].see(ball, pixel[0]) || !rig.camera[1].see(ball, pixel[1]))
				continue;
			pong_sighting sighting = {};
			sighting.track = flight;
			sighting.utime = 1000000LL * flight + std::llround(1e6 * t);
			for (int side = 0; side < 2; side++)
				for (int axis = 0; axis < 2; axis++)
					sighting.uv[side][axis] = pixel[side][axis] + noise(random);
			result.sightings.push_back(sighting);
		}
	}
	return result;
}

double difference(const pong_rig &a, const pong::TrueRig &truth)
{
	return 1e3 * volume_error(truth, a.camera, pong::table_volume()).mean;
}

TEST(Refine, RecoversAKnockFromFlights)
{
	Knock knocked = knock();
	const pong::TrueRig truth = pong::true_rig(0);
	pong_refinement refinement;
	const double before = difference(knocked.knocked, truth);
	ASSERT_EQ(pong_refine(&knocked.knocked, PONG_RIGHT, knocked.sightings.data(),
			      static_cast<int>(knocked.sightings.size()), &refinement, nullptr),
		  PONG_FOUND);
	const double after = difference(knocked.knocked, truth);
	printf("# 0.05 degrees about every axis: %.2f mm before, %.2f mm after; %d bounces, epipolar %.3f px to %.3f "
	       "px\n",
	       before, after, refinement.bounces, refinement.epipolar_before, refinement.epipolar);
	EXPECT_GT(before, 10);
	EXPECT_LT(after, 2);
	EXPECT_GE(refinement.bounces, 20);
	EXPECT_LT(refinement.epipolar, 0.2);
}

TEST(Refine, LeavesTheRigAloneWithTooFew)
{
	Knock knocked = knock();
	const pong_rig before = knocked.knocked;
	pong_refinement refinement;
	pong_error error;
	EXPECT_EQ(pong_refine(&knocked.knocked, PONG_RIGHT, knocked.sightings.data(), 19, &refinement, &error),
		  PONG_ERROR_VALUE);
	EXPECT_STREQ(error.text, "19 sightings are too few to refine from: 20 are needed");
	EXPECT_EQ(before.camera[PONG_RIGHT].P[0][0], knocked.knocked.camera[PONG_RIGHT].P[0][0]);
}

} // namespace
