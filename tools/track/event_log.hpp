// LCM's event log, written by LCM's own code, and read with care.
//
// An event is: 0xeda1da01, its number (64 bits), its time (64 bits, us), the lengths of its channel's name and of its
// data (32 bits each), the name, the data; all big endian. LCM's own reader ends at a damaged event as at the end of
// the file, prints, and trusts lengths; this one tells the difference, since a recording may come from a full disk or
// from a machine that lost its power.
#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <lcm/lcm.h>

namespace track
{

class EventWriter
{
public:
	// Throws pong::Failure where the file cannot be made. Where nothing is ever written none is left behind, and
	// what was there before stays.
	explicit EventWriter(const std::string &path);
	~EventWriter();
	EventWriter(const EventWriter &) = delete;
	EventWriter &operator=(const EventWriter &) = delete;

	// The event is in the file, for whoever reads along, when this returns. False where the disk does not take it:
	// then the file ends with the event before, and takes no more; error() says why.
	bool write(const char *channel, int64_t utime, const uint8_t *data, size_t size);

	const std::string &path() const
	{
		return path_;
	}

	const std::string &error() const
	{
		return error_;
	}

	int64_t bytes() const
	{
		return bytes_;
	}

private:
	bool begin();
	void close_at_last_event();

	std::string path_, error_;
	bool made_ = false, begun_ = false;
	lcm_eventlog_t *log_ = nullptr;
	int64_t bytes_ = 0; // of whole events
};

struct Event {
	int64_t utime = 0;
	std::string channel;
	std::vector<uint8_t> data;
};

class EventReader
{
public:
	enum class Result {
		EVENT,
		END,
		CUT, // the file ends in the middle of an event
	};

	// The file is the caller's, and is read from front to back only: a pipe will do.
	explicit EventReader(FILE *file);

	Result next(Event &event);

	// Bytes that belong to no event: skipped.
	int64_t skipped() const
	{
		return skipped_;
	}

private:
	static constexpr size_t HEAD = 28;

	bool fill(size_t size);
	bool find_head();
	Result end();
	bool read(uint8_t *bytes, size_t size);

	FILE *file_;
	uint8_t head_[HEAD];
	size_t have_ = 0; // bytes of it
	int64_t skipped_ = 0;
};

} // namespace track
