#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "program.hpp"
#include "tools/simulate/scene.hpp"
#include "tools/simulate/truth.hpp"
#include "tools/simulate/world.hpp"

namespace
{

std::string error_of(const std::string &text)
{
	try {
		sim::parse_scene(text, "scene.toml");
	} catch (const pong::Failure &failure) {
		return failure.what();
	}
	return "";
}

TEST(SimulateScene, BuiltInScenesLoad)
{
	for (const sim::BuiltinScene &scene : sim::builtin_scenes())
		EXPECT_NO_THROW(sim::load_scene(scene.name)) << scene.name;
	EXPECT_EQ(sim::load_scene("people").people, 2);
	EXPECT_EQ(sim::load_scene("paper60").show, sim::Show::positions);
}

TEST(SimulateScene, SettingsAreReadOverABase)
{
	const sim::Scene scene = sim::parse_scene("base = 'whitewall'\n[rig]\ndistortion = [-0.15, 0, 0, 0, 0]\n"
						  "[light]\nkind = 'front'\n[flights]\nspin = 100\nspeed = [8, 8]\n",
						  "scene.toml");
	EXPECT_EQ(scene.background.level, 195);
	EXPECT_EQ(scene.rig.distortion[0], -0.15);
	EXPECT_EQ(scene.light.towards.z(), -1);
	EXPECT_EQ(scene.flights.spin, 100);
	EXPECT_EQ(scene.flights.speed[0], 8);
	EXPECT_EQ(scene.picture.blur, 0.6);
}

TEST(SimulateScene, ErrorsSayWhere)
{
	EXPECT_EQ(error_of("[light]\nlevel = 100\nbrightness = 3\n"),
		  "scene.toml:3:1: there is no setting 'light.brightness'");
	EXPECT_EQ(error_of("people = 7\n"), "scene.toml:1:10: people must lie between 0 and 2, not 7");
	EXPECT_EQ(error_of("[rig]\n\ndistortion = [1, 2]\n"), "scene.toml:3:14: rig.distortion needs 5 numbers, has 2");
	EXPECT_EQ(error_of("[light]\nkind = 'moon'\n"), "scene.toml:2:8: light.kind is one of overhead, front, "
							"diffuse, logo, specular, not 'moon'");
	EXPECT_EQ(error_of("[flights]\nspeed = [9, 7]\n"),
		  "scene.toml:2:9: flights.speed needs the smaller number first");
	EXPECT_EQ(error_of("base = 'nowhere'\n"), "scene.toml:1:8: base names no built-in scene: 'nowhere'");
	EXPECT_EQ(error_of("people = \n").substr(0, 13), "scene.toml:1:");
	EXPECT_THROW(sim::load_scene("no-such-scene"), pong::Failure);
}

TEST(SimulateWorld, SixtyPlacesAtThreeHeights)
{
	const std::vector<Eigen::Vector3d> places = sim::sixty_places();
	ASSERT_EQ(places.size(), 60u);
	for (size_t i = 0; i < places.size(); i++)
		EXPECT_EQ(places[i].y(), i < 20 ? 0.020 : i < 40 ? 0.220 : 0.420);
}

TEST(SimulateWorld, PlacesComeAfterEmptyFrames)
{
	const sim::Scene scene = sim::load_scene("paper60");
	sim::World world(scene, sim::make_rig(scene.rig), 1, 110, 1);
	for (int frame = 0; frame < 36; frame++) {
		const auto episode = world.at(frame / 110.0);
		ASSERT_EQ(episode != nullptr, frame % 12 >= 8) << frame;
		if (episode) {
			EXPECT_EQ(episode->number, frame / 12 + 1);
		}
	}
}

TEST(SimulateWorld, FlightsKeepTheirGap)
{
	const sim::Scene scene = sim::load_scene("paper66");
	const sim::Rig rig = sim::make_rig(scene.rig);
	sim::World world(scene, rig, 1, 110, 1), again(scene, rig, 1, 110, 1);
	EXPECT_EQ(world.count(), 66);
	EXPECT_EQ(world.at(0), nullptr);
	double last_end = 0;
	int last = 0;
	for (int frame = 0; frame < 400; frame++) {
		const auto episode = world.at(frame / 110.0), same = again.at(frame / 110.0);
		ASSERT_EQ(episode == nullptr, same == nullptr);
		if (!episode || episode->number == last)
			continue;
		EXPECT_EQ(episode->number, last + 1);
		EXPECT_GE(episode->begin - last_end, 0.4);
		EXPECT_EQ(episode->begin, same->begin);
		last = episode->number;
		last_end = episode->end;
	}
	EXPECT_GE(last, 2);
}

TEST(SimulateTruth, OneRowAFrame)
{
	const std::string path = testing::TempDir() + "truth.txt";
	const sim::Scene scene = sim::load_scene("rally");
	const sim::Rig rig = sim::make_rig(scene.rig);
	sim::World world(scene, rig, 1, 110, 1);
	const double time = 0.5; // the first flight begins after 0.4 s
	{
		sim::Truth truth(path, rig);
		truth.add(1000, 0, nullptr, 0);
		truth.add(2000000, 55, world.at(time).get(), time);
	}
	std::ifstream file(path);
	std::string names, empty, row;
	std::getline(file, names);
	std::getline(file, empty);
	std::getline(file, row);
	EXPECT_EQ(names, "# utime frame flight x y z vx vy vz wx wy wz left_u left_v right_u right_v seen_left "
			 "seen_right hit_utime hit_x hit_y hit_z");
	EXPECT_EQ(empty, "1000 0 - - - - - - - - - - - - - - - - - - - -");
	const pong::Table table(path);
	const auto episode = world.at(time);
	const double hit = 2e6 + 1e6 * (episode->begin + episode->flight->hit()->time - time);
	EXPECT_NEAR(table.get(1, table.column("hit_utime")), hit, 1);
	EXPECT_NEAR(table.get(1, table.column("z")), episode->ball(time).position.z(), 1e-6);
	EXPECT_EQ(table.get_integer(1, table.column("flight")), 1);
	EXPECT_EQ(table.get_integer(1, table.column("seen_left")), 1);
	std::remove(path.c_str());
}

// The plane's poses differ in z alone; all the others are wholly in view of both cameras.
TEST(SimulateBoard, PosesAreInView)
{
	const sim::Scene scene = sim::load_scene("board");
	const sim::Rig rig = sim::make_rig(scene.rig);
	const std::vector<sim::BoardPose> poses = sim::draw_poses(scene.board, rig, 1);
	ASSERT_EQ(poses.size(), 20u);
	EXPECT_NEAR(poses[0].origin.y(), 0, 1e-12);
	for (const sim::BoardPose &pose : poses) {
		if (!std::isnan(pose.plane_z)) {
			EXPECT_EQ(pose.origin.head<2>(), poses[1].origin.head<2>());
			EXPECT_EQ(pose.origin.z(), pose.plane_z);
		}
		EXPECT_NEAR(pose.R_table_board.determinant(), 1, 1e-9);
		for (const sim::Camera &camera : rig)
			for (const Eigen::Vector3d &corner : sim::outline(scene.board, pose)) {
				Eigen::Vector2d uv;
				ASSERT_TRUE(camera.project(corner, &uv));
				EXPECT_GE(uv.minCoeff(), 0);
				EXPECT_LE(uv.x(), 639);
				EXPECT_LE(uv.y(), 479);
			}
	}
}

// The errors are of the size that was asked for, about the board's middle; tilted poses, which nobody places, stay.
TEST(SimulateBoard, PlacedPosesAreMisplacedAsTold)
{
	sim::BoardSettings exact, wrong;
	wrong.misplaced = 0.0002;
	wrong.misturned = 0.001;
	const sim::Rig rig = sim::make_rig({});
	double shift = 0, turn = 0;
	const int seeds = 100;
	for (uint64_t seed = 1; seed <= seeds; seed++) {
		const auto should = sim::draw_poses(exact, rig, seed), is = sim::draw_poses(wrong, rig, seed);
		const Eigen::Vector3d middle(0.100, 0.0625, 0);
		for (size_t i = 0; i < is.size(); i++) {
			const bool placed = i == 0 || std::isfinite(is[i].plane_z);
			const Eigen::Matrix3d R = is[i].R_table_board * should[i].R_table_board.transpose();
			const Eigen::Vector3d moved = is[i].origin + is[i].R_table_board * middle - should[i].origin -
						      should[i].R_table_board * middle;
			EXPECT_TRUE(placed || (moved.norm() < 1e-12 && R.isIdentity(1e-9)));
			if (i != 1)
				continue;
			shift += moved.squaredNorm() / seeds;
			turn += std::pow(std::acos(std::min(1.0, (R.trace() - 1) / 2)), 2) / seeds;
		}
	}
	EXPECT_NEAR(std::sqrt(shift / 3), 0.0002, 0.00004);
	EXPECT_NEAR(std::sqrt(turn / 3), 0.001, 0.0002);
}

} // namespace
