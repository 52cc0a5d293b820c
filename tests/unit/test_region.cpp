// The search region, against points projected one by one.
#include <cmath>
#include <gtest/gtest.h>

#include "owned.hpp"
#include "rigs.hpp"

namespace
{

pong_settings best_settings()
{
	pong_settings settings;
	pong_settings_defaults(PONG_BEST, &settings);
	return settings;
}

// Wherever a ball over the table is seen, the region reaches, and allows for its size.
TEST(Region, HoldsEveryBallOverTheTable)
{
	const pong_rig rig = test_rig();
	const pong_settings settings = best_settings();
	const pong::OwnedRegion region(pong_region_new(&rig, PONG_RIGHT, &settings, nullptr));
	ASSERT_TRUE(region);
	int seen = 0;
	for (double x = -0.76; x <= 0.76; x += 0.04)
		for (double y = 0.02; y <= 1.0; y += 0.04)
			for (double z = 0; z <= 3.7; z += 0.1) {
				const double position[3] = {x, y, z};
				double uv[2];
				if (!pong_project(&rig.camera[PONG_RIGHT], position, uv) || uv[0] < 0 ||
				    uv[0] >= 639.5 || uv[1] < 0 || uv[1] >= 479.5)
					continue;
				const pong_region_row row =
					pong_region_get_row(region.get(), static_cast<int>(std::lround(uv[1])));
				const double size = pong_apparent_size(&rig.camera[PONG_RIGHT], position, 0.040);
				EXPECT_GE(uv[0] + 0.5, row.begin);
				EXPECT_LE(uv[0] - 0.5, row.end);
				EXPECT_GE(size, 0.97 * row.size_min);
				EXPECT_LE(size, 1.03 * row.size_max);
				seen++;
			}
	EXPECT_GT(seen, 10000);
}

// Low in the picture a ray soon ends on the table: a ball there is near, hence large.
TEST(Region, LowRowsHoldOnlyLargeBalls)
{
	const pong_rig rig = test_rig();
	const pong_settings settings = best_settings();
	const pong::OwnedRegion region(pong_region_new(&rig, PONG_LEFT, &settings, nullptr));
	const pong_region_row high = pong_region_get_row(region.get(), 20),
			      low = pong_region_get_row(region.get(), 460);
	EXPECT_LT(high.size_min, 12);
	EXPECT_GT(low.size_min, 30);
}

// Seen from far above, the table's side lines bound the region on both sides.
TEST(Region, EndsAtTheSideLines)
{
	pong_rig rig = test_rig();
	pong_settings settings = best_settings();
	settings.region.ceiling = 0.05;
	settings.region.margin = 0;
	// A camera 6 m above the middle of the table that looks straight down; image down is towards the robot.
	const double above[3][4] = {{-500, -320, 0, 320 * 6.0}, {0, -240, -500, 500 * 1.37 + 240 * 6}, {0, -1, 0, 6}};
	std::copy_n(&above[0][0], 12, &rig.camera[PONG_LEFT].P[0][0]);
	const pong::OwnedRegion region(pong_region_new(&rig, PONG_LEFT, &settings, nullptr));
	ASSERT_TRUE(region);
	const pong_region_row row = pong_region_get_row(region.get(), 240);
	EXPECT_NEAR(row.begin, 320 - 500 * 0.7625 / 6, 5);
	EXPECT_NEAR(row.end, 320 + 500 * 0.7625 / 6, 5);
	const pong_region_row beyond = pong_region_get_row(region.get(), 470);
	EXPECT_EQ(beyond.begin, beyond.end);
}

TEST(Region, IsTheWholePictureWithoutATable)
{
	pong_rig rig = test_rig();
	rig.table.present = 0;
	pong_settings settings = best_settings();
	settings.region.distance[0] = 1;
	settings.region.distance[1] = 10;
	const pong::OwnedRegion region(pong_region_new(&rig, PONG_LEFT, &settings, nullptr));
	const pong_region_row row = pong_region_get_row(region.get(), 100);
	EXPECT_EQ(row.begin, 0);
	EXPECT_EQ(row.end, 640);
	EXPECT_NEAR(row.size_max, 1081 * 0.040 / 1, 1e-6);
	EXPECT_NEAR(row.size_min, 1081 * 0.040 / 10, 1e-6);
}

TEST(Region, SaysSoWhereACameraDoesNotSeeTheTable)
{
	pong_rig rig = test_rig();
	for (double &element : rig.camera[PONG_RIGHT].P[2])
		element = -element; // looks the other way
	for (int i = 0; i < 2; i++)
		for (double &element : rig.camera[PONG_RIGHT].P[i])
			element = -element;
	for (auto &row : rig.camera[PONG_RIGHT].P)
		for (int i = 0; i < 3; i++)
			row[i] = -row[i];
	pong_error error = {};
	const pong_settings settings = best_settings();
	EXPECT_EQ(pong_region_new(&rig, PONG_RIGHT, &settings, &error), nullptr);
	EXPECT_NE(std::string(error.text).find("right camera does not see"), std::string::npos) << error.text;
}

} // namespace
