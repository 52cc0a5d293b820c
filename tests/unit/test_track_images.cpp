#include "images.hpp"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

#include "program.hpp"

namespace
{

namespace fs = std::filesystem;
using track::ImageFiles;
using track::list_images;
using track::Next;
using track::StereoPair;

class TrackImages : public testing::Test
{
protected:
	TrackImages()
		: folder_(fs::temp_directory_path() / ("pongeye-images-" + std::to_string(getpid()) +
						       testing::UnitTest::GetInstance()->current_test_info()->name()))
	{
		fs::create_directories(folder_);
	}

	~TrackImages() override
	{
		fs::remove_all(folder_);
	}

	void write(const std::string &file, const std::string &text) const
	{
		std::ofstream(folder_ / file, std::ios::binary) << text;
	}

	// A picture of 3 x 2 pixels. The reader goes by content: a PGM will do.
	void write_picture(const std::string &file, const std::string &pixels = "abcdef") const
	{
		write(file, "P5\n3 2\n255\n" + pixels);
	}

	void write_pair(const std::string &name) const
	{
		write_picture(name + "-left.png");
		write_picture(name + "-right.png", "ghijkl");
	}

	std::string folder() const
	{
		return folder_.string();
	}

	template<class Function> std::string failure_of(Function function) const
	{
		try {
			function();
		} catch (const pong::Failure &failure) {
			return failure.what();
		}
		return "no failure";
	}

	std::string list_failure(double fps = 0) const
	{
		return failure_of([&] { list_images(folder(), fps); });
	}

private:
	fs::path folder_;
};

TEST_F(TrackImages, NumbersSortByValueAndGiveTheTime)
{
	for (const char *name : {"10", "9", "011", "2"})
		write_pair(name);
	const std::vector<ImageFiles> list = list_images(folder(), 100);
	ASSERT_EQ(list.size(), 4u);
	const int64_t frames[] = {2, 9, 10, 11};
	for (size_t i = 0; i < 4; i++) {
		EXPECT_EQ(list[i].frame, frames[i]);
		EXPECT_EQ(list[i].utime, frames[i] * 10000);
	}
	EXPECT_EQ(list[3].right, folder() + "/011-right.png");
}

TEST_F(TrackImages, WithoutFpsItIs110)
{
	write_pair("110");
	EXPECT_EQ(list_images(folder(), 0)[0].utime, 1000000);
}

TEST_F(TrackImages, TimesTableForWords)
{
	write_pair("b");
	write_pair("a");
	write("times.txt", "# frame utime\n5 1700000000000001\n7 1700000000018182\n");
	const std::vector<ImageFiles> list = list_images(folder(), 0);
	ASSERT_EQ(list.size(), 2u);
	EXPECT_EQ(list[0].left, folder() + "/a-left.png");
	EXPECT_EQ(list[0].frame, 5);
	EXPECT_EQ(list[0].utime, 1700000000000001);
	EXPECT_EQ(list[1].frame, 7);
}

TEST_F(TrackImages, FpsGoesBeforeTheTimesTableOfNumbers)
{
	write_pair("3");
	write("times.txt", "# frame utime\n3 123456\n");
	EXPECT_EQ(list_images(folder(), 0)[0].utime, 123456);
	EXPECT_EQ(list_images(folder(), 1)[0].utime, 3000000);
}

TEST_F(TrackImages, WordsWithoutTimes)
{
	write_pair("1");
	write_pair("serve");
	EXPECT_EQ(list_failure(110), folder() +
					     ": picture name 'serve' is not a frame number, and there is no times.txt "
					     "with columns frame and utime");
}

TEST_F(TrackImages, TimesTableOfAnotherLength)
{
	write_pair("a");
	write("times.txt", "# frame utime\n1 2\n3 4\n");
	EXPECT_EQ(list_failure(), folder() + "/times.txt: 2 rows for 1 picture names; there must be one for each");
}

TEST_F(TrackImages, EmptyFolder)
{
	write("notes.txt", "");
	EXPECT_EQ(list_failure(), folder() + ": no pictures NAME-left.png, NAME-right.png in this folder");
}

TEST_F(TrackImages, NoFolder)
{
	EXPECT_EQ(failure_of([&] { list_images(folder() + "/no", 0); }), folder() + "/no: No such file or directory");
	write("file", "");
	EXPECT_EQ(failure_of([&] { list_images(folder() + "/file", 0); }), folder() + "/file: Not a directory");
}

TEST_F(TrackImages, ReadsPixels)
{
	write_pair("7");
	const auto source = track::open_images(folder(), 100, 0.002);
	StereoPair pair;
	ASSERT_EQ(source->next(pair), Next::PAIR);
	EXPECT_EQ(pair.exposure_us[PONG_LEFT], 2000);
	EXPECT_EQ(pair.exposure_us[PONG_RIGHT], 2000);
	EXPECT_EQ(pair.frame, 7);
	EXPECT_EQ(pair.left.width, 3);
	EXPECT_EQ(pair.left.height, 2);
	EXPECT_EQ(pair.left.pixels[pair.left.stride + 2], 'f');
	EXPECT_EQ(pair.right.pixels[0], 'g');
	EXPECT_EQ(source->next(pair), Next::END);
}

TEST_F(TrackImages, PictureWithoutPartnerIsSkippedAndCounted)
{
	write_pair("1");
	write_picture("2-left.png");
	write_picture("3-right.png");
	write_pair("4");
	const auto source = track::open_images(folder(), 100, 0);
	StereoPair pair;
	ASSERT_EQ(source->next(pair), Next::PAIR);
	ASSERT_EQ(source->next(pair), Next::PAIR);
	EXPECT_EQ(pair.frame, 4);
	EXPECT_EQ(source->next(pair), Next::END);
	EXPECT_EQ(source->dropped().unpaired, 2);
}

TEST_F(TrackImages, NoPartnersAtAll)
{
	write_picture("2-left.png");
	EXPECT_EQ(failure_of([&] { track::open_images(folder(), 100, 0); }),
		  folder() + ": no picture has a partner of the other side");
}

TEST_F(TrackImages, WhatIsNoPicture)
{
	write_picture("1-left.png");
	write("1-right.png", "not a picture");
	const auto source = track::open_images(folder(), 100, 0);
	StereoPair pair;
	EXPECT_EQ(failure_of([&] { source->next(pair); }), folder() + "/1-right.png: cannot be read as a picture");
}

} // namespace
