// Faults on order: how they are asked for, and when they strike.
#include <gtest/gtest.h>

#include "fault_list.hpp"
#include "program.hpp"
#include "scene.hpp"

namespace sim
{

namespace
{

using gige::Fault;
using gige::FaultKind;
using gige::Faults;

std::array<std::vector<Fault>, 2> parse(const std::string &list)
{
	const Scene scene = load_scene("rally");
	const World world(scene, make_rig(scene.rig), 5, 110, 1);
	return parse_faults(list, world);
}

TEST(SimulateFaults, ReadsKindAmountAndTime)
{
	const auto faults = parse("right:die@3+1.5,both:lose=0.001");
	ASSERT_EQ(faults[0].size(), 1u);
	ASSERT_EQ(faults[1].size(), 2u);
	EXPECT_EQ(faults[1][0].kind, FaultKind::die);
	EXPECT_DOUBLE_EQ(faults[1][0].begin, 3);
	EXPECT_DOUBLE_EQ(faults[1][0].end, 4.5);
	EXPECT_DOUBLE_EQ(faults[0][0].amount, 0.001);
	EXPECT_EQ(faults[0][0].begin, 0);
}

TEST(SimulateFaults, TakesTheTimesOfFlights)
{
	const auto faults = parse("left:freeze@flight2+1,left:freeze@bounce2+1");
	const Scene scene = load_scene("rally");
	World world(scene, make_rig(scene.rig), 5, 110, 1);
	const double flying = faults[0][0].begin, bouncing = faults[0][1].begin;
	ASSERT_NE(world.at(flying), nullptr);
	EXPECT_EQ(world.at(flying)->number, 2);
	EXPECT_GT(world.at(flying)->ball(flying).position.y(), 0.05);
	EXPECT_NEAR(world.at(bouncing)->ball(bouncing).position.y(), 0.02, 0.005);
	EXPECT_DOUBLE_EQ(faults[0][0].end, flying + 1);
}

TEST(SimulateFaults, RefusesNonsense)
{
	for (const char *list : {"die", "middle:die", "left:explode", "left:lose", "left:lose=2", "left:die@soon",
				 "left:die@1+", "left:block=0", "left:die@bounce0"})
		EXPECT_THROW(parse(list), pong::UsageError) << list;
}

TEST(SimulateFaults, StrikeInTheirTimeOnly)
{
	Faults faults({{FaultKind::miss, 1, 1, 2}}, 100, 1);
	EXPECT_FALSE(faults.strikes(FaultKind::miss, 100)); // at 0.99 s
	EXPECT_TRUE(faults.strikes(FaultKind::miss, 101));
	EXPECT_TRUE(faults.strikes(FaultKind::miss, 200));
	EXPECT_FALSE(faults.strikes(FaultKind::miss, 201));
	EXPECT_FALSE(faults.strikes(FaultKind::lose, 150));
}

TEST(SimulateFaults, StrikeAsOftenAsTold)
{
	Faults faults({{FaultKind::lose, 0.1}}, 100, 1);
	int lost = 0;
	for (int i = 0; i < 10000; i++)
		lost += faults.strikes(FaultKind::lose, 1);
	EXPECT_NEAR(lost, 1000, 150); // five standard deviations
}

} // namespace

} // namespace sim
