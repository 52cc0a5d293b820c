// Writes what a session sees and says into an LCM event log: pictures, messages, trigger pulses, the rig.
//
// Whoever tracks only copies into memory; a thread of its own writes. What the disk cannot take is left out and
// counted, where the pictures come from cameras; pictures from files can wait.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "event_log.hpp"
#include "pair_message.hpp"
#include "pongeye/recording_t.hpp"
#include "record_queue.hpp"
#include "worth_keeping.hpp"

namespace track
{

enum RecordWhat { RECORD_ALL, RECORD_WINDOWS, RECORD_MESSAGES };

// The words for these, in their order.
const std::vector<std::string> &record_what_words();

struct RecordSettings {
	std::string path;
	int what = RECORD_ALL;
	double last = 0;       // s to be held in memory until save(); 0: everything is written at once
	double rate = 0;       // pairs a second, to measure the memory by; 0: not known
	bool live = true;      // never wait for the disk
	size_t queue_size = 0; // bytes; 0: for about a second
};

class Recorder
{
public:
	// Throws pong::Failure where the file cannot be made or the memory is not there.
	Recorder(const RecordSettings &settings, const pongeye::recording_t &header, const pong_rig &rig,
		 const pong_settings &eye);
	~Recorder();
	Recorder(const Recorder &) = delete;
	Recorder &operator=(const Recorder &) = delete;

	// From one thread. `channel` is a literal; utime is that of the pair that a message tells of, 0: of none.
	void add_message(const char *channel, int64_t utime, const uint8_t *data, size_t size);
	void add_pair(const StereoPair &pair, const pong_sight &sight);

	// A picture without a partner that the eye has seen: a replay gives the same only if it shows it too. Without
	// all pictures it does not anyway.
	void add_alone(const StereoPair &alone);

	// Write what is held in memory, into a file of its own.
	void save();

	// Write what waits, and end. Returns what there is to say about the recording.
	std::string finish();

	// Whether everything that was to be written is.
	bool good() const
	{
		return !failed_;
	}

private:
	uint8_t *reserve(size_t size);
	int64_t now() const;
	void commit(const char *channel, int64_t utime);

	void write_all();
	bool write(const Record &record);
	bool write_header(int64_t utime);
	void begin_file(int64_t utime);
	void end_file(int64_t utime);
	void end_in_failure(const std::string &why);
	void tell_what_is_left_out();

	const RecordSettings settings_;
	pongeye::recording_t header_;
	WorthKeeping worth_keeping_;
	RecordQueue queue_;
	int64_t utime_ = 0; // of the newest record: time in the log never goes back
	int64_t pairs_ = 0; // that there were
	std::atomic<int64_t> left_out_{0}, messages_left_out_{0};
	std::atomic<bool> failed_{false};

	// The writing thread's, and finish()'s when that has ended.
	std::unique_ptr<EventWriter> writer_; // null while nothing is due
	bool begun_ = false;                  // the file has its header
	bool skips_ = false;                  // what is due could not be written
	bool told_ = false;                   // that the disk is too slow
	int64_t first_utime_ = 0, pairs_written_ = 0;
	int files_ = 0;
	std::thread thread_;
};

} // namespace track
