// What waits to be written: records of any size in memory that is taken once, at the start.
//
// One thread puts records in and one takes them out; neither holds the lock while it copies or writes. A queue that
// holds back gives nothing out until release(), and forgets its oldest records for new ones: the last seconds.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

namespace track
{

struct Record {
	const char *channel; // a literal
	int64_t utime;
	const uint8_t *data;
	size_t size;
	bool ends_release; // the last one that a release() gave out
};

class RecordQueue
{
public:
	enum class Mode { PASS, HOLD_BACK };

	RecordQueue(size_t bytes, size_t records, Mode mode);

	// The putter's. Room for one record, to be filled and then committed; null where there is none.
	uint8_t *reserve(size_t size);
	// The same, but where there is none wait for it; null only where the queue is given up or could never have it.
	uint8_t *reserve_patiently(size_t size);
	void commit(const char *channel, int64_t utime);

	// Forget held records from before a time.
	void forget_before(int64_t utime);

	// Give out all that is held back, with the records that are put in until that is done.
	void release();

	// Nothing comes any more.
	void close();

	// The taker's. Wait for a record; false where none comes any more. It stays where it is until drop().
	bool take(Record &record);
	void drop();

	// Nobody takes any more.
	void give_up();

private:
	struct Entry {
		const char *channel;
		int64_t utime;
		size_t begin, size;
	};

	Entry &entry(uint64_t number);
	bool has_entries() const;
	bool held() const;
	bool find_room(size_t size);
	bool make_room(size_t size);
	void forget_oldest();

	std::vector<uint8_t> bytes_;
	std::vector<Entry> entries_; // by number, modulo their count
	const Mode mode_;

	std::mutex mutex_; // guards what follows
	std::condition_variable filled_, emptied_;
	uint64_t first_ = 0, next_ = 0; // numbers of the oldest record, and of the next to come
	uint64_t due_;                  // records below this may be taken
	size_t end_ = 0;                // where the newest record ends
	size_t reserved_begin_ = 0, reserved_size_ = 0;
	bool closed_ = false, given_up_ = false;
};

} // namespace track
