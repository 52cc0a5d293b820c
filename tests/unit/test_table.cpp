// Tables as text: what is read, and what is refused.
#include "table.hpp"

#include <cmath>
#include <fstream>
#include <gtest/gtest.h>

#include "program.hpp"

namespace
{

pong::Table table_of(const std::string &text)
{
	const std::string path = testing::TempDir() + "table.txt";
	std::ofstream(path) << text;
	return pong::Table(path);
}

TEST(Table, ReadsNumbersAndWhatIsAbsent)
{
	const pong::Table table = table_of("## made by hand\n# utime x\n9007199254740993 -0.5\n\n# a comment\n-7 -\n");
	ASSERT_EQ(table.rows(), 2u);
	EXPECT_EQ(table.get_integer(0, table.column("utime")), 9007199254740993); // more digits than a double has
	EXPECT_EQ(table.get(0, table.column("x")), -0.5);
	EXPECT_EQ(table.get_integer(1, table.column("utime")), -7);
	EXPECT_TRUE(std::isnan(table.get(1, table.column("x"))));
}

TEST(Table, RefusesWhatIsNone)
{
	for (const char *text : {"", "1 2\n", "#\n1\n", "# a b\n1\n", "# a b\n1 2 3\n"})
		EXPECT_THROW(table_of(text), pong::Failure) << text;
	EXPECT_THROW(table_of("# a\n1\n").column("b"), pong::Failure);
}

TEST(Table, RefusesWhatIsNoWholeNumber)
{
	for (const char *cell : {"-", "1.5", "1e6", "x", "9223372036854775808", "-99999999999999999999"})
		EXPECT_THROW(table_of(std::string("# a\n") + cell + "\n").get_integer(0, 0), pong::Failure) << cell;
}

} // namespace
