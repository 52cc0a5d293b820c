// What is recorded, and what a replay makes of it.
#include "recorder.hpp"

#include <cmath>
#include <fcntl.h>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "program.hpp"
#include "replay.hpp"
#include "rigs.hpp"

namespace
{

namespace fs = std::filesystem;
using namespace track;

constexpr int WIDTH = 640, HEIGHT = 480;
constexpr int64_t PERIOD = 10000; // us

class RecorderTest : public testing::Test
{
protected:
	RecorderTest() : folder_(fs::temp_directory_path() / ("pongeye-recorder-" + std::to_string(getpid())))
	{
		fs::create_directories(folder_);
		settings_.path = (folder_ / "test.lcm").string();
		settings_.live = false;
		pong_settings_defaults(PONG_BEST, &eye_);
		header_.profile = "paper";
		header_.rig_name = "rig.toml";
		header_.rig = "[left]\n";
	}

	~RecorderTest() override
	{
		fs::remove_all(folder_);
	}

	// Pictures with a stride, and a value that tells pixel, side and frame.
	StereoPair pair(int64_t frame)
	{
		for (const int side : {PONG_LEFT, PONG_RIGHT})
			for (int v = 0; v < HEIGHT; v++)
				for (int u = 0; u < WIDTH; u++)
					pixels_[side][v * STRIDE + u] = pixel(side, u, v, frame);
		return {1000000 + PERIOD * frame,
			frame,
			{pixels_[PONG_LEFT].data(), WIDTH, HEIGHT, STRIDE},
			{pixels_[PONG_RIGHT].data(), WIDTH, HEIGHT, STRIDE},
			0};
	}

	static uint8_t pixel(int side, int u, int v, int64_t frame)
	{
		return static_cast<uint8_t>(u + 3 * v + 5 * frame + 7 * side);
	}

	static bool is_frame(const pong_image &image, int side, int64_t frame)
	{
		for (int v = 0; v < HEIGHT; v += 7)
			for (int u = 0; u < WIDTH; u++)
				if (image.pixels[v * image.stride + u] != pixel(side, u, v, frame))
					return false;
		return true;
	}

	pong_sight ball_at(const StereoPair &of, double z) const
	{
		pong_sight sight = {};
		sight.has_ball = 1;
		sight.ball.utime = of.utime;
		sight.ball.position[1] = 0.3;
		sight.ball.position[2] = z;
		sight.ball.velocity[2] = -5;
		return sight;
	}

	std::unique_ptr<Recorder> recorder()
	{
		return std::make_unique<Recorder>(settings_, header_, test_rig(), eye_);
	}

	std::vector<fs::path> files() const
	{
		std::vector<fs::path> found;
		for (const auto &entry : fs::directory_iterator(folder_))
			found.push_back(entry.path());
		return found;
	}

	static constexpr ptrdiff_t STRIDE = WIDTH + 32;
	fs::path folder_;
	RecordSettings settings_;
	pongeye::recording_t header_;
	pong_settings eye_;
	std::vector<uint8_t> pixels_[2] = {std::vector<uint8_t>(STRIDE * HEIGHT), std::vector<uint8_t>(STRIDE *HEIGHT)};
};

TEST_F(RecorderTest, WholePairsComeBack)
{
	auto recorder = this->recorder();
	for (int64_t frame = 5; frame < 25; frame++)
		recorder->add_pair(pair(frame), {});
	EXPECT_NE(recorder->finish().find("20 pairs"), std::string::npos);
	EXPECT_TRUE(recorder->good());

	Replay replay(settings_.path);
	EXPECT_EQ(replay.profile(), PONG_PAPER);
	EXPECT_EQ(replay.rig().text, "[left]\n");
	StereoPair read;
	for (int64_t frame = 5; frame < 25; frame++) {
		ASSERT_EQ(replay.next(read), Next::PAIR);
		EXPECT_EQ(read.frame, frame);
		EXPECT_EQ(read.utime, 1000000 + PERIOD * frame);
		EXPECT_TRUE(is_frame(read.left, PONG_LEFT, frame));
		EXPECT_TRUE(is_frame(read.right, PONG_RIGHT, frame));
	}
	EXPECT_EQ(replay.next(read), Next::END);
}

TEST_F(RecorderTest, APictureAloneComesBackInItsPlace)
{
	auto recorder = this->recorder();
	recorder->add_pair(pair(1), {});
	StereoPair alone = pair(2);
	alone.left = {};
	recorder->add_alone(alone);
	recorder->add_pair(pair(3), {});
	EXPECT_NE(recorder->finish().find("2 pairs"), std::string::npos);

	Replay replay(settings_.path);
	StereoPair read;
	ASSERT_EQ(replay.next(read), Next::PAIR);
	ASSERT_EQ(replay.next(read), Next::ALONE);
	EXPECT_EQ(read.utime, alone.utime);
	EXPECT_EQ(read.left.pixels, nullptr);
	EXPECT_TRUE(is_frame(read.right, PONG_RIGHT, 2));
	ASSERT_EQ(replay.next(read), Next::PAIR);
	EXPECT_TRUE(is_frame(read.left, PONG_LEFT, 3));
	EXPECT_EQ(replay.next(read), Next::END);
}

TEST_F(RecorderTest, WindowsComeBackWithinTheLastWholePair)
{
	settings_.what = RECORD_WINDOWS;
	auto recorder = this->recorder();
	const pong_rig rig = test_rig();
	for (int64_t frame = 0; frame < 20; frame++) {
		const StereoPair now = pair(frame);
		recorder->add_pair(now, frame == 0 ? pong_sight{} : ball_at(now, 2.5 - 0.05 * frame));
	}
	recorder->finish();
	EXPECT_LT(fs::file_size(settings_.path), 20u * 2 * WIDTH * HEIGHT / 5);

	Replay replay(settings_.path);
	StereoPair read;
	for (int64_t frame = 0; frame < 20; frame++) {
		ASSERT_EQ(replay.next(read), Next::PAIR);
		const double position[3] = {0, 0.3, 2.5 - 0.05 * static_cast<double>(frame)};
		double uv[2];
		for (const int side : {PONG_LEFT, PONG_RIGHT}) {
			const pong_image &image = side == PONG_LEFT ? read.left : read.right;
			ASSERT_TRUE(pong_project(&rig.camera[side], position, uv));
			const int u = static_cast<int>(uv[0]), v = static_cast<int>(uv[1]);
			for (int du = -30; du <= 30; du += 10)
				EXPECT_EQ(image.pixels[v * image.stride + u + du], pixel(side, u + du, v, frame));
			EXPECT_EQ(image.pixels[0], pixel(side, 0, 0, 0)); // of the whole pair
		}
	}
}

TEST_F(RecorderTest, MessagesAloneAreNoPictures)
{
	settings_.what = RECORD_MESSAGES;
	auto recorder = this->recorder();
	const uint8_t message[] = {1, 2, 3};
	recorder->add_pair(pair(1), {});
	recorder->add_message("PONGEYE_BALL", 1000000, message, sizeof message);
	recorder->finish();
	EXPECT_LT(fs::file_size(settings_.path), 1000u);
	EXPECT_THROW(Replay{settings_.path}, pong::Failure);
}

// The lengths of its texts are whatever a damaged file says.
TEST_F(RecorderTest, ADamagedHeaderIsNoHeader)
{
	auto recorder = this->recorder();
	recorder->add_pair(pair(1), {});
	recorder->finish();
	std::ifstream file(settings_.path, std::ios::binary);
	const std::string whole(std::istreambuf_iterator<char>(file), {});
	const size_t profile = whole.find(std::string("\0\0\0\6paper", 9));
	ASSERT_NE(profile, std::string::npos);
	for (const char *length : {"\x80\0\0\0", "\xff\xff\xff\xff", "\x7f\xff\xff\xff", "\0\0\0\0", "\0\0\1\0"}) {
		std::string damaged = whole;
		damaged.replace(profile, 4, length, 4);
		std::ofstream(settings_.path, std::ios::binary) << damaged;
		Replay replay(settings_.path);
		EXPECT_THROW(replay.rig(), pong::Failure);
		StereoPair read;
		EXPECT_EQ(replay.next(read), Next::PAIR);
	}
}

// A pipe that nobody reads is the slowest disk. Whoever tracks goes on, and every pair is written or counted.
TEST_F(RecorderTest, ASlowDiskLosesPairsAndCountsThem)
{
	ASSERT_EQ(mkfifo(settings_.path.c_str(), 0600), 0);
	const int pipe = open(settings_.path.c_str(), O_RDWR);
	settings_.live = true;
	settings_.queue_size = 3 * 2 * WIDTH * HEIGHT;
	auto recorder = this->recorder();
	constexpr int PAIRS = 50;
	for (int64_t frame = 0; frame < PAIRS; frame++)
		recorder->add_pair(pair(frame), {});

	std::string bytes;
	std::string summary;
	std::thread ender([&] { summary = recorder->finish(); });
	const std::string end = "end of the pipe";
	std::thread marker([&] {
		ender.join();
		EXPECT_EQ(write(pipe, end.data(), end.size()), static_cast<ssize_t>(end.size()));
	});
	char buffer[65536];
	while (bytes.size() < end.size() || bytes.compare(bytes.size() - end.size(), end.size(), end) != 0) {
		const ssize_t got = read(pipe, buffer, sizeof buffer);
		ASSERT_GT(got, 0);
		bytes.append(buffer, static_cast<size_t>(got));
	}
	marker.join();
	close(pipe);
	const fs::path copy = folder_ / "copy.lcm";
	std::ofstream(copy, std::ios::binary)
		.write(bytes.data(), static_cast<std::streamsize>(bytes.size() - end.size()));

	Replay replay(copy.string());
	StereoPair read;
	int pairs = 0;
	for (; replay.next(read) == Next::PAIR; pairs++)
		EXPECT_TRUE(is_frame(read.right, PONG_RIGHT, read.frame));
	EXPECT_GE(pairs, 2);
	EXPECT_LT(pairs, PAIRS);
	EXPECT_NE(summary.find(std::to_string(PAIRS - pairs) + " pairs and 0 messages left out"), std::string::npos)
		<< summary;
}

TEST_F(RecorderTest, TheLastSecondsAreSavedOnRequest)
{
	settings_.last = 0.1;
	settings_.rate = 100;
	auto recorder = this->recorder();
	for (int64_t frame = 0; frame < 30; frame++)
		recorder->add_pair(pair(frame), {});
	recorder->save();
	recorder->finish();
	ASSERT_EQ(files().size(), 1u);
	EXPECT_NE(files()[0].string().find("test-19700101-00000"), std::string::npos);
	Replay replay(files()[0].string());
	StereoPair read;
	for (int64_t frame = 19; frame < 30; frame++) {
		ASSERT_EQ(replay.next(read), Next::PAIR);
		EXPECT_EQ(read.frame, frame);
	}
	EXPECT_EQ(replay.next(read), Next::END);
}

TEST_F(RecorderTest, NothingIsSavedUnasked)
{
	settings_.last = 1;
	auto recorder = this->recorder();
	recorder->add_pair(pair(0), {});
	EXPECT_NE(recorder->finish().find("nothing was recorded"), std::string::npos);
	EXPECT_TRUE(files().empty());
}

TEST_F(RecorderTest, MoreMemoryThanThereIsIsRefused)
{
	settings_.last = 3600;
	settings_.rate = 10000;
	EXPECT_THROW(recorder(), pong::Failure);
}

TEST(Parts, OutsideOfThePictureAreRefused)
{
	uint8_t pixels[12] = {};
	const StereoPair pair = {1, 1, {pixels, 4, 3, 4}, {pixels, 4, 3, 4}, 0};
	const Parts parts = {{{1, 1, 2, 2}, {0, 0, 4, 3}}};
	std::vector<uint8_t> data(encoded_size(parts));
	encode(pair, parts, 1, data.data());
	pongeye::pair_t message, decoded;
	ASSERT_TRUE(decode(data, message));
	EXPECT_EQ(message.getEncodedSize(), static_cast<int>(data.size()));
	const auto decodes = [&] {
		message.encode(data.data(), 0, static_cast<int>(data.size()));
		return decode(data, decoded);
	};
	EXPECT_TRUE(decodes());
	Unpacker unpacker;
	StereoPair unpacked;
	EXPECT_FALSE(unpacker.unpack(decoded, unpacked)); // no whole left picture yet
	message.part_u[0] = 3;
	EXPECT_FALSE(decodes());
	message.part_u[0] = INT32_MAX;
	EXPECT_FALSE(decodes());
	message.part_u[0] = -1;
	EXPECT_FALSE(decodes());
	message.part_u[0] = 1;
	message.width[1] = message.part_width[1] = 5; // more pixels than there are
	EXPECT_FALSE(decodes());
	message.width[1] = message.part_width[1] = 4;
	EXPECT_TRUE(decodes());
	data.pop_back();
	EXPECT_FALSE(decode(data, decoded));
}

} // namespace
