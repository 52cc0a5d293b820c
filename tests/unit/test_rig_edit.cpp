// A rig.toml changed in place.
#include "rig_edit.hpp"

#include <gtest/gtest.h>

#include "program.hpp"

namespace
{

using calibrate::with_camera;
using calibrate::with_section;

const std::string left =
	"[left] # of the robot\nsize = [640, 480]\nP = [1000, 0, 320, 0, 0, 1000, 240, 0, 0, 0, 1, 0]\n";
const std::string right_begin = "[right]\nsize = [640, 480]\nP = ", right_end = " # measured on a Monday\n";
const std::string right = right_begin + "[1000, 0, 320, -180, 0, 1000, 240, 0, 0, 0, 1, 0]" + right_end;

TEST(RigEdit, ReplacesOnePAndNothingElse)
{
	pong_rig rig;
	pong_error error;
	ASSERT_EQ(pong_rig_parse((left + right).c_str(), "rig.toml", &rig, &error), PONG_FOUND) << error.text;
	pong_camera camera = rig.camera[PONG_RIGHT];
	camera.P[0][3] = -180.5;
	const std::string edited = with_camera(left + right, "rig.toml", PONG_RIGHT, camera);
	EXPECT_EQ(edited.find(left + right_begin), 0u);
	EXPECT_EQ(edited.substr(edited.size() - right_end.size()), right_end);
	ASSERT_EQ(pong_rig_parse(edited.c_str(), "edited", &rig, &error), PONG_FOUND) << error.text;
	EXPECT_EQ(rig.camera[PONG_RIGHT].P[0][3], -180.5);
	EXPECT_EQ(rig.camera[PONG_LEFT].P[0][3], 0);
}

TEST(RigEdit, ASectionIsAddedOrReplaced)
{
	const std::string added = with_section(left + right, "rig.toml", "note", "[note]\na = 1\n");
	EXPECT_EQ(added, left + right + "\n[note]\na = 1\n");
	EXPECT_EQ(with_section(added, "rig.toml", "note", "[note]\na = 2\n"), left + right + "\n[note]\na = 2\n");
	EXPECT_EQ(with_section("[note]\nb = 3\n" + left, "rig.toml", "note", "[note]\na = 1\n"),
		  left + "\n[note]\na = 1\n");
}

// Whatever stands in the way: refused, and never a file that cannot be read, or that says something else.
TEST(RigEdit, ASectionThatCannotBeReplacedIsRefused)
{
	for (const std::string other : {"[ note ]\nb = 1\n", "note.b = 1\n", "[hit]\nname = '''\n[note]\n'''\n"})
		EXPECT_THROW(with_section(other + left, "rig.toml", "note", "[note]\na = 1\n"), pong::Failure) << other;
}

} // namespace
