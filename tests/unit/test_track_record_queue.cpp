#include "record_queue.hpp"

#include <cstring>
#include <deque>
#include <gtest/gtest.h>
#include <random>
#include <thread>

namespace
{

using track::Record;
using track::RecordQueue;
using Mode = RecordQueue::Mode;

bool put(RecordQueue &queue, uint8_t value, size_t size, int64_t utime = 0)
{
	uint8_t *room = queue.reserve(size);
	if (!room)
		return false;
	memset(room, value, size);
	queue.commit("CHANNEL", utime);
	return true;
}

// The value of the oldest record, which must be whole.
int take(RecordQueue &queue, bool *ends_release = nullptr)
{
	Record record;
	if (!queue.take(record))
		return -1;
	for (size_t i = 0; i < record.size; i++)
		EXPECT_EQ(record.data[i], record.data[0]);
	const int value = record.data[0];
	if (ends_release)
		*ends_release = record.ends_release;
	queue.drop();
	return value;
}

TEST(RecordQueue, GivesInOrderAndRefusesWhenFull)
{
	RecordQueue queue(100, 10, Mode::PASS);
	EXPECT_TRUE(put(queue, 1, 60));
	EXPECT_FALSE(put(queue, 2, 60));
	EXPECT_TRUE(put(queue, 3, 40));
	EXPECT_FALSE(put(queue, 4, 1));
	EXPECT_EQ(take(queue), 1);
	EXPECT_TRUE(put(queue, 5, 60)); // at the front again
	EXPECT_EQ(take(queue), 3);
	EXPECT_EQ(take(queue), 5);
	queue.close();
	EXPECT_EQ(take(queue), -1);
}

TEST(RecordQueue, TheCountOfRecordsIsBoundedToo)
{
	RecordQueue queue(100, 2, Mode::PASS);
	EXPECT_TRUE(put(queue, 1, 1));
	EXPECT_TRUE(put(queue, 2, 1));
	EXPECT_FALSE(put(queue, 3, 1));
}

TEST(RecordQueue, IsAQueueWhateverTheSizes)
{
	RecordQueue queue(1000, 20, Mode::PASS);
	std::deque<uint8_t> expected;
	std::mt19937 random(3);
	uint8_t value = 0;
	int refused = 0;
	for (int run = 0; run < 20000; run++) {
		if (random() % 2) {
			if (put(queue, ++value, 1 + random() % 300))
				expected.push_back(value);
			else
				refused++;
		} else if (!expected.empty()) {
			ASSERT_EQ(take(queue), expected.front());
			expected.pop_front();
		}
	}
	EXPECT_GT(refused, 100);
}

TEST(RecordQueue, HoldsTheNewestBackUntilTheyAreReleased)
{
	RecordQueue queue(100, 10, Mode::HOLD_BACK);
	for (uint8_t value = 1; value <= 9; value++)
		EXPECT_TRUE(put(queue, value, 30, value)); // room for three
	queue.release();
	EXPECT_FALSE(put(queue, 10, 30)); // what is being written is not forgotten
	bool ends = true;
	EXPECT_EQ(take(queue, &ends), 7);
	EXPECT_FALSE(ends);
	EXPECT_TRUE(put(queue, 11, 30));
	EXPECT_EQ(take(queue, &ends), 8);
	EXPECT_EQ(take(queue, &ends), 9);
	EXPECT_TRUE(ends);
	queue.close(); // 11 is held back again
	EXPECT_EQ(take(queue), -1);
}

TEST(RecordQueue, ForgetsWhatIsTooOld)
{
	RecordQueue queue(1000, 10, Mode::HOLD_BACK);
	for (uint8_t value = 1; value <= 6; value++)
		put(queue, value, 10, 100 * value);
	queue.forget_before(400);
	queue.release();
	EXPECT_EQ(take(queue), 4);
}

TEST(RecordQueue, AnEmptyReleaseReleasesNothing)
{
	RecordQueue queue(100, 10, Mode::HOLD_BACK);
	queue.release();
	put(queue, 1, 10);
	queue.close();
	EXPECT_EQ(take(queue), -1);
}

TEST(RecordQueue, PatienceWaitsForRoom)
{
	RecordQueue queue(100, 10, Mode::PASS);
	constexpr int RECORDS = 2000;
	std::thread putter([&] {
		for (int i = 0; i < RECORDS; i++) {
			uint8_t *room = queue.reserve_patiently(40);
			memset(room, i & 0xff, 40);
			queue.commit("CHANNEL", i);
		}
		queue.close();
	});
	for (int i = 0; i < RECORDS; i++)
		ASSERT_EQ(take(queue), i & 0xff);
	EXPECT_EQ(take(queue), -1);
	putter.join();
}

TEST(RecordQueue, PatienceEndsWhereNobodyTakes)
{
	RecordQueue queue(100, 10, Mode::PASS);
	EXPECT_FALSE(queue.reserve_patiently(101)); // never
	put(queue, 1, 100);
	queue.give_up();
	EXPECT_FALSE(queue.reserve_patiently(1));
}

} // namespace
