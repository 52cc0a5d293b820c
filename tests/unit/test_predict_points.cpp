// pongeye-predict's reader: other people's tables, and what is wrong with some of them.
#include <gtest/gtest.h>
#include <sstream>

#include "predict/points.hpp"
#include "program.hpp"

namespace
{

struct Read {
	std::vector<predict::Row> rows;
	int64_t skipped;
	size_t ignored;
};

Read read(const std::string &text)
{
	std::istringstream stream(text);
	predict::PointReader reader(stream, "points");
	Read result = {};
	predict::Row row;
	while (reader.next(&row))
		result.rows.push_back(row);
	result.skipped = reader.skipped();
	result.ignored = reader.ignored().size();
	return result;
}

std::string refusal(const std::string &text)
{
	try {
		read(text);
	} catch (const pong::Failure &failure) {
		return failure.what();
	}
	return "";
}

TEST(PredictPoints, ReadsColumnsInAnyOrder)
{
	const Read result = read("# z t x y\n3 0.5 1 2\n");
	ASSERT_EQ(result.rows.size(), 1u);
	EXPECT_EQ(result.rows[0].point.utime, 500000);
	EXPECT_EQ(result.rows[0].point.position[2], 3);
	EXPECT_TRUE(result.rows[0].begins_flight);
}

TEST(PredictPoints, ABlankLinePartsFlights)
{
	const Read result = read("t x y z\n0 1 2 3\n1 1 2 3\n\n\n0 1 2 3\n");
	ASSERT_EQ(result.rows.size(), 3u);
	EXPECT_EQ(result.rows[1].flight, "0");
	EXPECT_TRUE(result.rows[2].begins_flight);
	EXPECT_EQ(result.rows[2].flight, "1");
}

TEST(PredictPoints, AFlightColumnPartsFlights)
{
	const Read result = read("flight,t,x,y,z\na,0,1,2,3\nb,0,1,2,3\n");
	ASSERT_EQ(result.rows.size(), 2u);
	EXPECT_TRUE(result.rows[1].begins_flight);
	EXPECT_EQ(result.rows[1].flight, "b");
}

TEST(PredictPoints, SkipsAndCountsWhatCannotBeUsed)
{
	const Read result = read("# t x y z\n0 1 2 3\n1 nan 2 3\n2 1 inf 3\n3 1 2 -\n0 1 2 3\n4 1 2 3\n1e300 1 2 3\n");
	EXPECT_EQ(result.rows.size(), 2u);
	EXPECT_EQ(result.skipped, 5);
}

TEST(PredictPoints, TakesStandardDeviations)
{
	const Read result = read("# t x y z sx sy sz other\n0 1 2 3 0.1 0.2 0.3 9\n");
	EXPECT_DOUBLE_EQ(result.rows[0].point.covariance[2][2], 0.09);
	EXPECT_EQ(result.ignored, 1u);
}

TEST(PredictPoints, RefusesWhatIsNoTable)
{
	EXPECT_NE(refusal("# t x y\n").find("points:1: names no column 'z'"), std::string::npos);
	EXPECT_NE(refusal("# t x y z\n0 1 2\n").find("points:2: has 3 columns, the table 4"), std::string::npos);
	EXPECT_NE(refusal("# t x y z\n0 1 two 3\n").find("points:2: y is 'two', not a number"), std::string::npos);
	EXPECT_NE(refusal("# t x x y z\n").find("names column 'x' twice"), std::string::npos);
}

} // namespace
