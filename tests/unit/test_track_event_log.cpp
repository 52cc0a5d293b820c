// LCM's event log as we write it and read it, against LCM's own reader.
#include "event_log.hpp"

#include <csignal>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <random>
#include <sys/resource.h>
#include <unistd.h>

#include "program.hpp"

namespace
{

namespace fs = std::filesystem;
using track::Event;
using track::EventReader;
using track::EventWriter;
using Result = EventReader::Result;

class EventLog : public testing::Test
{
protected:
	EventLog() : path_(fs::temp_directory_path() / ("pongeye-events-" + std::to_string(getpid())))
	{
	}

	~EventLog() override
	{
		fs::remove(path_);
	}

	std::string path() const
	{
		return path_.string();
	}

	std::string write_three() const
	{
		EventWriter writer(path());
		for (uint8_t i = 1; i <= 3; i++) {
			const std::vector<uint8_t> data(size_t{10} * i, i);
			EXPECT_TRUE(writer.write("CHANNEL", 1000 * i, data.data(), data.size()));
		}
		std::ifstream file(path_, std::ios::binary);
		return std::string(std::istreambuf_iterator<char>(file), {});
	}

private:
	fs::path path_;
};

struct ReadLog {
	std::vector<Event> events;
	Result end;
	int64_t skipped;
};

ReadLog read_log(const std::string &bytes)
{
	FILE *file = tmpfile();
	fwrite(bytes.data(), 1, bytes.size(), file);
	rewind(file);
	EventReader reader(file);
	ReadLog log = {};
	Event event;
	while ((log.end = reader.next(event)) == Result::EVENT)
		log.events.push_back(event);
	log.skipped = reader.skipped();
	fclose(file);
	return log;
}

TEST_F(EventLog, LcmReadsWhatIsWritten)
{
	write_three();
	lcm_eventlog_t *log = lcm_eventlog_create(path().c_str(), "r");
	ASSERT_TRUE(log);
	for (int i = 1; i <= 3; i++) {
		lcm_eventlog_event_t *event = lcm_eventlog_read_next_event(log);
		ASSERT_TRUE(event);
		EXPECT_EQ(event->eventnum, i - 1);
		EXPECT_EQ(event->timestamp, 1000 * i);
		EXPECT_STREQ(event->channel, "CHANNEL");
		EXPECT_EQ(event->datalen, 10 * i);
		EXPECT_EQ(static_cast<uint8_t *>(event->data)[0], i);
		lcm_eventlog_free_event(event);
	}
	EXPECT_FALSE(lcm_eventlog_read_next_event(log));
	lcm_eventlog_destroy(log);
}

TEST_F(EventLog, ComesBack)
{
	const ReadLog log = read_log(write_three());
	ASSERT_EQ(log.events.size(), 3u);
	EXPECT_EQ(log.end, Result::END);
	EXPECT_EQ(log.skipped, 0);
	EXPECT_EQ(log.events[2].utime, 3000);
	EXPECT_EQ(log.events[2].channel, "CHANNEL");
	EXPECT_EQ(log.events[2].data, std::vector<uint8_t>(30, 3));
}

// Wherever the file ends, what is whole before is there, and the cut is told from an end.
TEST_F(EventLog, IsReadToWhereItIsCut)
{
	const std::string bytes = write_three();
	const size_t first = 28 + 7 + 10, second = first + 28 + 7 + 20;
	ASSERT_EQ(bytes.size(), second + 28 + 7 + 30);
	for (size_t size = 0; size <= bytes.size(); size++) {
		const ReadLog log = read_log(bytes.substr(0, size));
		const bool whole = size == 0 || size == first || size == second || size == bytes.size();
		EXPECT_EQ(log.events.size(), size < first ? 0u : size < second ? 1u : size < bytes.size() ? 2u : 3u);
		EXPECT_EQ(log.end, whole ? Result::END : Result::CUT) << size;
		EXPECT_EQ(log.skipped, 0);
	}
}

TEST_F(EventLog, DamageIsSkippedAndCounted)
{
	std::string bytes = write_three();
	bytes[0] = 'x';
	bytes += "tail";
	const ReadLog log = read_log("rubbish" + bytes);
	ASSERT_EQ(log.events.size(), 2u);
	EXPECT_EQ(log.events[0].utime, 2000);
	EXPECT_EQ(log.end, Result::END);
	EXPECT_EQ(log.skipped, 7 + 28 + 7 + 10 + 4);
}

// A stated length that cannot be takes no memory.
TEST_F(EventLog, LengthsAreNotTrusted)
{
	std::string bytes = write_three();
	for (const size_t length : {20, 24})
		for (int i = 0; i < 4; i++)
			bytes[length + static_cast<size_t>(i)] = '\xff';
	EXPECT_EQ(read_log(bytes).events.size(), 2u);
	bytes.replace(20, 8, std::string("\0\0\0\7\x0f\xff\xff\xff", 8));
	const ReadLog log = read_log(bytes);
	EXPECT_EQ(log.events.size(), 0u);
	EXPECT_EQ(log.end, Result::CUT);
}

TEST_F(EventLog, AnyBytesAreSurvived)
{
	const std::string good = write_three();
	std::mt19937 random(1);
	for (int run = 0; run < 300; run++) {
		std::string bytes = good;
		for (int i = 0; i < 4; i++)
			bytes[random() % bytes.size()] = static_cast<char>(random());
		EXPECT_LE(read_log(bytes).events.size(), 3u);
	}
}

TEST_F(EventLog, AFolderIsRefused)
{
	EXPECT_THROW(EventWriter(fs::temp_directory_path().string()), pong::Failure);
}

// The limit on the size of a file stands for a full disk. What does not fit is cut off: the file ends with a whole
// event.
TEST_F(EventLog, AFullDiskLeavesWholeEvents)
{
	rlimit before;
	getrlimit(RLIMIT_FSIZE, &before);
	const std::vector<uint8_t> data(100000, 7);
	EventWriter writer(path());
	const rlimit limit = {250000, before.rlim_max};
	setrlimit(RLIMIT_FSIZE, &limit);
	EXPECT_TRUE(writer.write("CHANNEL", 1, data.data(), data.size()));
	EXPECT_TRUE(writer.write("CHANNEL", 2, data.data(), data.size()));
	EXPECT_FALSE(writer.write("CHANNEL", 3, data.data(), data.size()));
	EXPECT_FALSE(writer.write("CHANNEL", 4, data.data(), 1));
	setrlimit(RLIMIT_FSIZE, &before);
	EXPECT_EQ(writer.error(), "File too large");
	EXPECT_EQ(writer.bytes(), 2 * (28 + 7 + 100000));
	std::ifstream file(path(), std::ios::binary);
	const ReadLog log = read_log(std::string(std::istreambuf_iterator<char>(file), {}));
	EXPECT_EQ(log.events.size(), 2u);
	EXPECT_EQ(log.end, Result::END);
}

} // namespace
