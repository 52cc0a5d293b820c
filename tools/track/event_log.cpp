#include "event_log.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <unistd.h>

#include "big_endian.hpp"
#include "program.hpp"

namespace track
{

namespace
{

constexpr uint32_t MAGIC = 0xeda1da01;
constexpr uint32_t LONGEST_CHANNEL = 63;                 // LCM's own limit
constexpr uint32_t LARGEST_EVENT = 256u * 1024u * 1024u; // far above two pictures: what is more is damage
constexpr size_t READ_AT_ONCE = 1024 * 1024;             // memory grows only with what is really in the file

} // namespace

// A file that cannot be written is found out now. What it holds from before stays until there is something to write.
EventWriter::EventWriter(const std::string &path) : path_(path)
{
	const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0666);
	made_ = file >= 0;
	if (made_)
		close(file);
	else if (errno != EEXIST || access(path.c_str(), W_OK) != 0)
		throw pong::Failure(path + ": " + strerror(errno));
	else if (std::filesystem::is_directory(path))
		throw pong::Failure(path + ": " + strerror(EISDIR));
	// A limit on the size of files is a full disk too, and nothing to die of.
	signal(SIGXFSZ, SIG_IGN);
}

EventWriter::~EventWriter()
{
	if (log_)
		lcm_eventlog_destroy(log_);
	else if (made_ && !begun_)
		unlink(path_.c_str());
}

bool EventWriter::begin()
{
	begun_ = true;
	errno = 0;
	log_ = lcm_eventlog_create(path_.c_str(), "w");
	if (!log_)
		error_ = strerror(errno ? errno : EIO);
	return log_ != nullptr;
}

bool EventWriter::write(const char *channel, int64_t utime, const uint8_t *data, size_t size)
{
	if (begun_ ? !log_ : !begin())
		return false;
	const size_t length = strlen(channel);
	lcm_eventlog_event_t event = {};
	event.timestamp = utime;
	event.channellen = static_cast<int32_t>(length);
	event.datalen = static_cast<int32_t>(size);
	event.channel = const_cast<char *>(channel);
	event.data = const_cast<uint8_t *>(data);
	errno = 0;
	if (lcm_eventlog_write_event(log_, &event) != 0 || fflush(log_->f) != 0) {
		error_ = strerror(errno ? errno : EIO);
		close_at_last_event();
		return false;
	}
	constexpr size_t HEAD = 28;
	bytes_ += static_cast<int64_t>(HEAD + length + size);
	return true;
}

// What the stream still holds goes to the file first, or fails to: only then is it cut.
void EventWriter::close_at_last_event()
{
	lcm_eventlog_destroy(log_);
	log_ = nullptr;
	// What is no file, a pipe, cannot be cut; its reader finds the end by itself.
	if (truncate(path_.c_str(), bytes_) != 0 && errno != EINVAL)
		error_ += std::string(", and its last event cannot be cut off: ") + strerror(errno);
}

EventReader::EventReader(FILE *file) : file_(file)
{
}

bool EventReader::read(uint8_t *bytes, size_t size)
{
	return fread(bytes, 1, size, file_) == size;
}

// Have `size` bytes of a head.
bool EventReader::fill(size_t size)
{
	if (have_ < size)
		have_ += fread(head_ + have_, 1, size - have_, file_);
	return have_ >= size;
}

// Byte by byte to the next head that can be one. False at the end of the file.
bool EventReader::find_head()
{
	while (fill(HEAD)) {
		const uint32_t channel = load32(head_ + 20), data = load32(head_ + 24);
		if (load32(head_) == MAGIC && channel >= 1 && channel <= LONGEST_CHANNEL && data <= LARGEST_EVENT)
			return true;
		memmove(head_, head_ + 1, --have_);
		skipped_++;
	}
	return false;
}

// What is left is shorter than a head: the beginning of one, or nothing of ours.
EventReader::Result EventReader::end()
{
	static constexpr uint8_t BEGIN[] = {MAGIC >> 24, MAGIC >> 16 & 0xff, MAGIC >> 8 & 0xff, MAGIC & 0xff};
	const size_t left = have_;
	have_ = 0;
	if (left > 0 && memcmp(head_, BEGIN, std::min(left, sizeof BEGIN)) == 0)
		return Result::CUT;
	skipped_ += static_cast<int64_t>(left);
	return Result::END;
}

EventReader::Result EventReader::next(Event &event)
{
	if (!find_head())
		return end();
	have_ = 0;
	event.utime = load64(head_ + 12);
	event.channel.resize(load32(head_ + 20));
	if (!read(reinterpret_cast<uint8_t *>(&event.channel[0]), event.channel.size()))
		return Result::CUT;
	const size_t size = load32(head_ + 24);
	event.data.clear();
	while (event.data.size() < size) {
		const size_t before = event.data.size();
		event.data.resize(std::min(size, before + READ_AT_ONCE));
		if (!read(event.data.data() + before, event.data.size() - before))
			return Result::CUT;
	}
	return Result::EVENT;
}

} // namespace track
