#include "capture_settings.hpp"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

#include "program.hpp"

namespace
{

class TrackCaptureSettings : public testing::Test
{
protected:
	TrackCaptureSettings()
		: path_((std::filesystem::temp_directory_path() / ("pongeye-rig-" + std::to_string(getpid()) + ".toml"))
				.string())
	{
	}

	~TrackCaptureSettings() override
	{
		std::filesystem::remove(path_);
	}

	track::CaptureSettings load(const std::string &text) const
	{
		std::ofstream(path_) << text;
		return track::load_capture_settings(path_);
	}

	// What load() complains about, less the path.
	std::string failure_of(const std::string &text) const
	{
		try {
			load(text);
		} catch (const pong::Failure &failure) {
			return std::string(failure.what()).substr(path_.size());
		}
		return "no failure";
	}

private:
	std::string path_;
};

TEST_F(TrackCaptureSettings, Defaults)
{
	const track::CaptureSettings settings = load("[left]\ncamera = \"a\"\n");
	EXPECT_EQ(settings.exposure, 0);
	EXPECT_FALSE(settings.has_gain);
	EXPECT_EQ(settings.trigger, "Line1");
	EXPECT_EQ(settings.rate, 0);
	EXPECT_EQ(settings.packet_size, 0);
}

TEST_F(TrackCaptureSettings, All)
{
	const track::CaptureSettings settings =
		load("[capture]\nexposure = 0.002\ngain = 6\ntrigger = \"none\"\n"
		     "rate = 110\npacket_size = 9000\npacket_delay = 1e-5\ncounter = false\nptp = false\n"
		     "edge = \"falling\"\noffset = [16, 8]\n");
	EXPECT_EQ(settings.exposure, 0.002);
	EXPECT_TRUE(settings.has_gain);
	EXPECT_EQ(settings.gain, 6);
	EXPECT_EQ(settings.trigger, "");
	EXPECT_EQ(settings.rate, 110);
	EXPECT_EQ(settings.packet_size, 9000);
	EXPECT_EQ(settings.packet_delay, 1e-5);
	EXPECT_FALSE(settings.counter);
	EXPECT_FALSE(settings.ptp);
	EXPECT_TRUE(settings.falling_edge);
	EXPECT_EQ(settings.offset_x, 16);
	EXPECT_EQ(settings.offset_y, 8);
}

TEST_F(TrackCaptureSettings, Complaints)
{
	EXPECT_EQ(failure_of("[capture]\nexposre = 1\n"),
		  ":2:1: unknown key 'exposre' in [capture]: there are exposure, gain, trigger, edge, rate, offset, "
		  "counter, ptp, packet_size, packet_delay");
	EXPECT_EQ(failure_of("[capture]\nexposure = 2000\n"),
		  ":2:12: capture.exposure must be a number between 1e-06 and 1 s");
	EXPECT_EQ(failure_of("[capture]\ngain = \"high\"\n"),
		  ":2:8: capture.gain must be a number between -100 and 100 dB");
	EXPECT_EQ(failure_of("[capture]\ntrigger = 1\n"),
		  ":2:11: capture.trigger must be a text, such as \"Line1\" or \"none\"");
	EXPECT_EQ(failure_of("[capture]\npacket_size = 9000.5\n"),
		  ":2:15: capture.packet_size must be a whole number between 576 and 16000 bytes");
	EXPECT_EQ(failure_of("[capture]\nedge = \"up\"\n"), ":2:8: capture.edge must be \"rising\" or \"falling\"");
	EXPECT_EQ(failure_of("[capture]\noffset = [1]\n"), ":2:10: capture.offset must be two whole numbers, [x, y]");
	EXPECT_EQ(failure_of("[capture]\noffset = [1, -4]\n"),
		  ":2:10: capture.offset must be two whole numbers, [x, y], between 0 and 65535 px");
	EXPECT_EQ(failure_of("capture = 1\n"), ":1:11: capture must be a section, [capture]");
}

TEST_F(TrackCaptureSettings, NoFile)
{
	EXPECT_THROW(track::load_capture_settings("/nowhere/rig.toml"), pong::Failure);
}

} // namespace
