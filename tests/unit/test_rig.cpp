// rig.toml: what is read, what is refused, and where it says the fault lies.
#include <cmath>
#include <cstring>
#include <fstream>
#include <gtest/gtest.h>
#include <string>

#include "rigs.hpp"

namespace
{

const std::string left = "[left]\nsize = [640, 480]\nP = [-1000, 0, 320, 0, 0, -1000, 240, 0, 0, 0, 1, 0]\n";
const std::string right = "[right]\nsize = [640, 480]\nP = [-1000, 0, 320, -180, 0, -1000, 240, 0, 0, 0, 1, 0]\n";

struct Parsed {
	int code;
	pong_rig rig;
	pong_error error;
};

Parsed parse(const std::string &text)
{
	Parsed parsed = {};
	parsed.code = pong_rig_parse(text.c_str(), "rig.toml", &parsed.rig, &parsed.error);
	return parsed;
}

TEST(Rig, ReadsWithDefaults)
{
	const Parsed parsed = parse(left + right);
	ASSERT_EQ(parsed.code, PONG_FOUND) << parsed.error.text;
	EXPECT_EQ(parsed.rig.ball.diameter, 0.040);
	EXPECT_EQ(parsed.rig.table.present, 0);
	EXPECT_EQ(parsed.rig.hit_z, 0);
	EXPECT_EQ(parsed.rig.camera[PONG_RIGHT].width, 640);
	EXPECT_EQ(parsed.rig.camera[PONG_RIGHT].P[0][3], -180);
	EXPECT_EQ(parsed.rig.camera[PONG_LEFT].distortion[0], 0);
}

TEST(Rig, AnEmptyTableSectionIsTheUsualTable)
{
	const Parsed parsed = parse("[table]\n" + left + right);
	ASSERT_EQ(parsed.code, PONG_FOUND) << parsed.error.text;
	EXPECT_EQ(parsed.rig.table.present, 1);
	EXPECT_EQ(parsed.rig.table.length, 2.74);
}

// P is known up to scale and sign; the library's third row gives the depth in metres.
TEST(Rig, ScalesPToMetres)
{
	std::string scaled = left;
	scaled.replace(scaled.find("P ="), std::string::npos,
		       "P = [2000, 0, -640, 0, 0, 2000, -480, 0, 0, 0, -2, 0]\n");
	const Parsed parsed = parse(scaled + right);
	ASSERT_EQ(parsed.code, PONG_FOUND) << parsed.error.text;
	EXPECT_NEAR(parsed.rig.camera[PONG_LEFT].P[2][2], 1, 1e-12);
	EXPECT_NEAR(parsed.rig.camera[PONG_LEFT].P[0][0], -1000, 1e-9);
}

TEST(Rig, WritesWhatItReads)
{
	pong_rig rig = test_rig();
	strcpy(rig.camera[PONG_LEFT].id, "a \"name\"");
	rig.camera[PONG_LEFT].distortion[1] = 1.0 / 3;
	rig.hit_z = -0.1;
	char text[4096];
	ASSERT_LT(pong_rig_format(&rig, text, sizeof text), static_cast<int>(sizeof text));
	const Parsed parsed = parse(text);
	ASSERT_EQ(parsed.code, PONG_FOUND) << parsed.error.text;
	EXPECT_STREQ(parsed.rig.camera[PONG_LEFT].id, rig.camera[PONG_LEFT].id);
	EXPECT_EQ(parsed.rig.camera[PONG_LEFT].distortion[1], 1.0 / 3);
	EXPECT_EQ(parsed.rig.hit_z, -0.1);
	for (int i = 0; i < 12; i++)
		EXPECT_NEAR((&parsed.rig.camera[PONG_RIGHT].P[0][0])[i], (&rig.camera[PONG_RIGHT].P[0][0])[i], 1e-12);
}

TEST(Rig, FormatSaysHowMuchRoomItNeeds)
{
	const pong_rig rig = test_rig();
	char small[10];
	EXPECT_GT(pong_rig_format(&rig, small, sizeof small), 10);
	EXPECT_EQ(strlen(small), 9u);
}

// Each bad text, its code and the words that must be in the sentence.
TEST(Rig, SaysWhatIsWrongAndWhere)
{
	const struct {
		std::string text;
		int code;
		const char *sentence;
	} cases[] = {
		{"[left\n", PONG_ERROR_FORMAT, "rig.toml:1:"},
		{right, PONG_ERROR_FORMAT, "section [left] is missing"},
		{"[left]\nsize = [640, 480]\n" + right, PONG_ERROR_FORMAT, "rig.toml:1:1: left.P is missing"},
		{"[left]\nsize = [640, 480]\nP = [1, 2, 3]\n" + right, PONG_ERROR_FORMAT,
		 "rig.toml:3:5: left.P needs 12 numbers, has 3"},
		{"[left]\nsize = [640, 480]\nP = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]\n" + right, PONG_ERROR_VALUE,
		 "rig.toml:3:5: left.P is not a camera"},
		{"[left]\nsize = [640, 480]\nP = [1e-9, 0, 0, 1e300, 0, 1e-9, 0, 0, 0, 0, 1e-9, 0]\n" + right,
		 PONG_ERROR_VALUE, "rig.toml:3:5: left.P is not a camera: its last column is too large"},
		{"[left]\nsize = [640, 480]\nP = [nan, 0, 320, 0, 0, -1, 240, 0, 0, 0, 1, 0]\n" + right,
		 PONG_ERROR_FORMAT, "rig.toml:3:6: left.P needs finite numbers"},
		{"[left]\nsize = [640.5, 480]\n" + right, PONG_ERROR_VALUE,
		 "rig.toml:2:8: left.size needs whole numbers"},
		{left + "distorsion = [0, 0, 0, 0, 0]\n" + right, PONG_ERROR_FORMAT,
		 "rig.toml:4:1: [left] has no key 'distorsion'"},
		{"[ball]\ndiameter = -1\n" + left + right, PONG_ERROR_VALUE,
		 "rig.toml:2:12: ball.diameter must lie between 0.001 and 1, is -1"},
		{"[ball]\nmass = \"heavy\"\n" + left + right, PONG_ERROR_FORMAT,
		 "rig.toml:2:8: ball.mass needs a number"},
		{"ball = 3\n" + left + right, PONG_ERROR_FORMAT, "rig.toml:1:8: ball must be a section: [ball]"},
		{"[left]\ncamera = 5\nsize = [640, 480]\n" + right, PONG_ERROR_FORMAT, "needs a text in quotes"},
	};
	for (const auto &bad : cases) {
		const Parsed parsed = parse(bad.text);
		EXPECT_EQ(parsed.code, bad.code) << bad.text;
		EXPECT_NE(std::string(parsed.error.text).find(bad.sentence), std::string::npos)
			<< "says '" << parsed.error.text << "', not '" << bad.sentence << "'";
	}
}

TEST(Rig, AFaultLeavesTheRigAsItWas)
{
	pong_rig rig = test_rig();
	const pong_rig before = rig;
	EXPECT_LT(pong_rig_parse("[left]", "rig.toml", &rig, nullptr), 0);
	EXPECT_EQ(memcmp(&rig, &before, sizeof rig), 0);
}

TEST(Rig, AMissingFileIsNamed)
{
	pong_rig rig;
	pong_error error;
	EXPECT_EQ(pong_rig_load("no/such/rig.toml", &rig, &error), PONG_ERROR_FILE);
	EXPECT_STREQ(error.text, "no/such/rig.toml: No such file or directory");
	EXPECT_EQ(pong_rig_load(".", &rig, &error), PONG_ERROR_FILE);
}

TEST(Settings, AreReadFromTheSameFile)
{
	const std::string path = testing::TempDir() + "settings.toml";
	std::ofstream(path) << left << right
			    << "[detect]\nmethod = \"difference\"\ngap = 3\n[region]\ndistance = [1, 9]\n";
	pong_settings settings;
	pong_error error = {};
	pong_settings_defaults(PONG_BEST, &settings);
	ASSERT_EQ(pong_settings_load(path.c_str(), &settings, &error), PONG_FOUND) << error.text;
	EXPECT_EQ(settings.detect.method, PONG_DETECT_DIFFERENCE);
	EXPECT_EQ(settings.detect.gap, 3);
	EXPECT_EQ(settings.region.distance[1], 9);

	std::ofstream(path) << "[detect]\ngap = 3\nmethod = \"guess\"\n";
	EXPECT_EQ(pong_settings_load(path.c_str(), &settings, &error), PONG_ERROR_VALUE);
	EXPECT_EQ(error.text, path + ":3:10: detect.method must be one of difference, double-difference");
}

TEST(Rig, AnyCameraNameIsWrittenAndReadAgain)
{
	pong_rig rig = test_rig(), again;
	pong_error error = {};
	char text[8192];
	strcpy(rig.camera[PONG_LEFT].id, "a\"b\\c\n\t\x7f\xc3\xa9");
	ASSERT_LT(pong_rig_format(&rig, text, sizeof text), static_cast<int>(sizeof text));
	ASSERT_EQ(pong_rig_parse(text, "text", &again, &error), PONG_FOUND) << error.text;
	EXPECT_STREQ(again.camera[PONG_LEFT].id, rig.camera[PONG_LEFT].id);
}

// What is read, written, read and written again: to the last digit.
void expect_the_same_again(const std::string &text)
{
	const Parsed read = parse(text);
	ASSERT_EQ(read.code, PONG_FOUND) << read.error.text << "\n" << text;
	char first[8192], second[8192];
	pong_rig_format(&read.rig, first, sizeof first);
	const Parsed again = parse(first);
	ASSERT_EQ(again.code, PONG_FOUND) << again.error.text << "\n" << first;
	pong_rig_format(&again.rig, second, sizeof second);
	EXPECT_STREQ(first, second);
}

std::string left_of(const std::string &P)
{
	return "[left]\nsize = [640, 480]\nP = [" + P + "]\n";
}

TEST(Rig, IsWrittenAsItIsRead)
{
	expect_the_same_again(left + right);
	expect_the_same_again(left_of("1000, 0, 320, 0, 0, 1000, 240, 0, 0, 3, 1, 0") + right);  // scaled
	expect_the_same_again(left_of("1000, 0, 320, 0, 0, 1000, 240, 0, 0, 5, -1, 0") + right); // mirrored
	expect_the_same_again(left_of("1, 0, 0, 1e300, 0, 1, 0, -5e-324, 0, 0, 1, 1e-310") + right);
	expect_the_same_again("[hit]\nz = -0.0\n" + left + right + "distortion = [-0.0, -0, 0, 0, 0]\n");
	expect_the_same_again("[hit]\nz = 12345678901234568.0\n" + left + right); // 17 digits, and no point
	expect_the_same_again("[hit]\nz = 12345678901234567\n" + left + right);
}

// What is just a camera is just a camera when it is read again: its pixels are 1e-9 as wide as they are high.
TEST(Rig, ACameraOnTheVergeIsReadAgain)
{
	int cameras = 0;
	for (int i = -500; i <= 500; i++) {
		char P[200];
		snprintf(P, sizeof P, "%.17g, 0, 0, 0, 0, 3, 0, 0, 0, 0, 3, 0", 3e-9 * std::sqrt(8) * (1 + i * 2e-16));
		if (parse(left_of(P) + right).code != PONG_FOUND)
			continue;
		cameras++;
		expect_the_same_again(left_of(P) + right);
	}
	EXPECT_GT(cameras, 0);
	EXPECT_LT(cameras, 1001);
}

// toml++ would end the program.
TEST(Rig, ATableWithoutANameIsRefused)
{
	pong_rig rig;
	pong_error error = {};
	EXPECT_EQ(pong_rig_parse("[= 4\n", "text", &rig, &error), PONG_ERROR_FORMAT);
	EXPECT_EQ(std::string(error.text).find("text:1:2: "), 0u) << error.text;
}

TEST(Settings, AreReadFromText)
{
	pong_settings settings;
	pong_error error = {};
	pong_settings_defaults(PONG_BEST, &settings);
	ASSERT_EQ(pong_settings_parse("[detect]\ngap = 3\n", "text", &settings, &error), PONG_FOUND) << error.text;
	EXPECT_EQ(settings.detect.gap, 3);
	EXPECT_EQ(pong_settings_parse("[detect]\ngap = 5\nmethod = 1\n", "text", &settings, &error), PONG_ERROR_FORMAT);
	EXPECT_STREQ(error.text, "text:3:10: detect.method needs a text in quotes");
	EXPECT_EQ(settings.detect.gap, 3);
}

TEST(Settings, ProfilesDiffer)
{
	pong_settings paper, best;
	pong_settings_defaults(PONG_PAPER, &paper);
	pong_settings_defaults(PONG_BEST, &best);
	EXPECT_EQ(paper.detect.method, PONG_DETECT_DIFFERENCE);
	EXPECT_EQ(paper.locate.method, PONG_LOCATE_GAUSSIAN);
	EXPECT_EQ(paper.track.state, PONG_STATE_TWO_HALVES);
	EXPECT_NE(best.locate.method, PONG_LOCATE_GAUSSIAN);
}

} // namespace
