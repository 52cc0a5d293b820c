#include "output.hpp"

#include <cmath>
#include <filesystem>
#include <gtest/gtest.h>
#include <unistd.h>

namespace
{

std::string path_of_test()
{
	return (std::filesystem::temp_directory_path() / ("pongeye-output-" + std::to_string(getpid()))).string();
}

pong_sight sight_with_ball()
{
	pong_sight sight = {};
	sight.has_ball = 1;
	sight.ball.centre[PONG_LEFT] = {101.5, 102.25, 9, {}, 0, 0, {}};
	sight.ball.centre[PONG_RIGHT] = {91.5, 102.5, 9, {}, 0, 0, {}};
	for (int i = 0; i < 3; i++) {
		sight.ball.position[i] = i + 0.5;
		sight.ball.velocity[i] = NAN;
		sight.ball.covariance[i][i] = (i + 1) * (i + 1) * 1e-6;
	}
	return sight;
}

void add_hit(pong_sight &sight)
{
	sight.has_prediction = 1;
	sight.prediction.has_hit = 1;
	sight.prediction.hit.utime = 1700000000500000;
	for (int i = 0; i < 3; i++)
		sight.prediction.hit.position[i] = 0.25 * i;
	for (int i = 0; i < 4; i++)
		sight.prediction.hit_covariance[i][i] = i == 2 ? NAN : 1e-4 * (i + 1) * (i + 1);
}

TEST(TrackOutput, OneRowAPair)
{
	const std::string path = path_of_test();
	track::StereoPair pair = {};
	pair.utime = 1700000000000000;
	pair.frame = 12;
	pong_sight sight = sight_with_ball();
	{
		track::Output output(path);
		output.write(pair, pong_sight{});
		output.write(pair, sight);
		add_hit(sight);
		output.write(pair, sight);
	}
	const pong::Table table(path);
	std::filesystem::remove(path);
	ASSERT_EQ(table.rows(), 3u);
	EXPECT_EQ(table.get_integer(0, table.column("frame")), 12);
	EXPECT_EQ(table.get_integer(0, table.column("utime")), 1700000000000000);
	EXPECT_TRUE(std::isnan(table.get(0, table.column("left_u"))));
	EXPECT_TRUE(std::isnan(table.get(1, table.column("hit_utime"))));
	EXPECT_EQ(table.get(1, table.column("left_v")), 102.25);
	EXPECT_EQ(table.get(1, table.column("right_u")), 91.5);
	EXPECT_EQ(table.get(1, table.column("z")), 2.5);
	EXPECT_TRUE(std::isnan(table.get(1, table.column("vx"))));
	EXPECT_NEAR(table.get(1, table.column("sz")), 3e-3, 1e-9);
	EXPECT_EQ(table.get_integer(2, table.column("hit_utime")), 1700000000500000);
	EXPECT_EQ(table.get(2, table.column("hit_y")), 0.25);
	EXPECT_NEAR(table.get(2, table.column("hit_sy")), 0.02, 1e-9);
	EXPECT_TRUE(std::isnan(table.get(2, table.column("hit_sz"))));
	EXPECT_NEAR(table.get(2, table.column("hit_st")), 0.04, 1e-9);
}

} // namespace
