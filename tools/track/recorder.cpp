#include "recorder.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <ctime>
#include <fstream>
#include <pthread.h>

#include "clock.hpp"
#include "program.hpp"

namespace track
{

namespace
{

constexpr double USUAL_RATE = 110;          // pairs a second, where nobody knows
constexpr size_t WINDOWS_SIZE = 64 * 1024;  // bytes of a pair's two windows, generously
constexpr size_t MESSAGES_SIZE = 16 * 1024; // bytes of a pair's messages, generously
constexpr size_t RECORDS_PER_PAIR = 4;      // pair, ball, prediction, pulse
constexpr size_t SLACK_PAIRS = 4;           // whole ones, however little is kept of most
constexpr double QUEUE_SECONDS = 1;         // how long the disk may stall

size_t whole_size(const pong_rig &rig)
{
	size_t size = 0;
	for (const pong_camera &camera : rig.camera)
		size += static_cast<size_t>(camera.width) * static_cast<size_t>(camera.height);
	return size;
}

double pairs_held(const RecordSettings &settings)
{
	return std::ceil((settings.last > 0 ? settings.last + QUEUE_SECONDS : QUEUE_SECONDS) *
			 (settings.rate > 0 ? settings.rate : USUAL_RATE));
}

size_t size_of_pair(const RecordSettings &settings, const pong_rig &rig)
{
	if (settings.what == RECORD_ALL)
		return MESSAGES_SIZE + whole_size(rig);
	return settings.what == RECORD_WINDOWS ? MESSAGES_SIZE + WINDOWS_SIZE : MESSAGES_SIZE;
}

// Bytes of memory that can be had; 0 where the system does not tell.
double available_memory()
{
	std::ifstream file("/proc/meminfo");
	double kilobytes = 0;
	for (std::string word; file >> word;)
		if (word == "MemAvailable:" && file >> kilobytes)
			return kilobytes * 1024;
	return 0;
}

size_t queue_size(const RecordSettings &settings, const pong_rig &rig)
{
	if (settings.queue_size > 0)
		return settings.queue_size;
	const double size = pairs_held(settings) * static_cast<double>(size_of_pair(settings, rig)) +
			    static_cast<double>(SLACK_PAIRS * whole_size(rig));
	const double available = available_memory();
	if (available > 0 && size > available)
		throw pong::Failure(pong::format("the recording needs %.1f GB of memory for its queue, and %.1f GB are "
						 "free: hold fewer seconds, or --record-what windows",
						 size * 1e-9, available * 1e-9));
	return static_cast<size_t>(size);
}

size_t queue_records(const RecordSettings &settings)
{
	return static_cast<size_t>(pairs_held(settings)) * RECORDS_PER_PAIR + 64;
}

// "flight.lcm" at a time: "flight-20260301-101500.250.lcm", UTC.
std::string path_at(const std::string &path, int64_t utime)
{
	const time_t seconds = utime / 1000000;
	tm parts;
	char text[32];
	gmtime_r(&seconds, &parts);
	strftime(text, sizeof text, "-%Y%m%d-%H%M%S", &parts);
	const size_t slash = path.rfind('/'), dot = path.rfind('.');
	const bool has_ending = dot != std::string::npos && (slash == std::string::npos || dot > slash);
	const size_t stem = has_ending ? dot : path.size();
	return path.substr(0, stem) + text + pong::format(".%03d", static_cast<int>(utime / 1000 % 1000)) +
	       path.substr(stem);
}

double megabytes(int64_t bytes)
{
	return static_cast<double>(bytes) * 1e-6;
}

} // namespace

const std::vector<std::string> &record_what_words()
{
	static const std::vector<std::string> words = {"all", "windows", "messages"};
	return words;
}

Recorder::Recorder(const RecordSettings &settings, const pongeye::recording_t &header, const pong_rig &rig,
		   const pong_settings &eye)
	: settings_(settings), header_(header), worth_keeping_(rig, eye),
	  queue_(queue_size(settings, rig), queue_records(settings),
		 settings.last > 0 ? RecordQueue::Mode::HOLD_BACK : RecordQueue::Mode::PASS)
{
	header_.what = record_what_words().at(static_cast<size_t>(settings.what));
	if (settings.last <= 0)
		writer_ = std::make_unique<EventWriter>(settings.path);
	thread_ = std::thread([this] { write_all(); });
}

Recorder::~Recorder()
{
	queue_.close();
	if (thread_.joinable())
		thread_.join();
}

// Only cameras don't wait.
uint8_t *Recorder::reserve(size_t size)
{
	return settings_.live ? queue_.reserve(size) : queue_.reserve_patiently(size);
}

// In the recording's time: pictures from files have one of their own.
int64_t Recorder::now() const
{
	return settings_.live ? unix_ns() / 1000 : utime_;
}

// Time in a log never goes back.
void Recorder::commit(const char *channel, int64_t utime)
{
	utime_ = std::max(utime_, utime);
	queue_.commit(channel, utime_);
	if (settings_.last > 0)
		queue_.forget_before(utime_ - std::llround(settings_.last * 1e6));
}

void Recorder::add_message(const char *channel, int64_t utime, const uint8_t *data, size_t size)
{
	if (uint8_t *room = reserve(size)) {
		memcpy(room, data, size);
		commit(channel, utime ? utime : now());
	} else {
		messages_left_out_++;
	}
}

void Recorder::add_pair(const StereoPair &pair, const pong_sight &sight)
{
	if (settings_.what == RECORD_MESSAGES)
		return;
	pairs_++;
	const Parts parts = settings_.what == RECORD_WINDOWS ? worth_keeping_.choose(pair, sight) : whole_of(pair);
	if (uint8_t *room = reserve(encoded_size(parts))) {
		encode(pair, parts, pairs_, room);
		commit("PONGEYE_PAIR", pair.utime);
	} else {
		left_out_++;
	}
}

void Recorder::add_alone(const StereoPair &alone)
{
	if (settings_.what != RECORD_ALL)
		return;
	const Parts parts = whole_of(alone);
	if (uint8_t *room = reserve(encoded_size(parts))) {
		encode(alone, parts, pairs_, room);
		commit("PONGEYE_ALONE", alone.utime);
	} else {
		left_out_++;
	}
}

void Recorder::save()
{
	queue_.release();
}

void Recorder::begin_file(int64_t utime)
{
	if (!writer_)
		writer_ = std::make_unique<EventWriter>(path_at(settings_.path, utime));
	begun_ = true;
	first_utime_ = utime;
	pairs_written_ = 0;
	files_++;
}

bool Recorder::write_header(int64_t utime)
{
	header_.utime = utime;
	std::vector<uint8_t> bytes(static_cast<size_t>(header_.getEncodedSize()));
	header_.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
	return writer_->write("PONGEYE_RECORDING", utime, bytes.data(), bytes.size());
}

bool Recorder::write(const Record &record)
{
	if (!begun_) {
		begin_file(record.utime);
		if (!write_header(record.utime))
			return false;
	}
	if (!writer_->write(record.channel, record.utime, record.data, record.size))
		return false;
	pairs_written_ += strcmp(record.channel, "PONGEYE_PAIR") == 0;
	return true;
}

// What was to be saved is.
void Recorder::end_file(int64_t utime)
{
	if (writer_)
		pong::say(pong::format("%s: the last %.2f s, %lld pairs, %.1f MB", writer_->path().c_str(),
				       static_cast<double>(utime - first_utime_) * 1e-6,
				       static_cast<long long>(pairs_written_), megabytes(writer_->bytes())));
	writer_.reset();
	begun_ = false;
	skips_ = false;
}

// The tracker goes on. What is held in memory is tried again at the next save().
void Recorder::end_in_failure(const std::string &why)
{
	failed_ = true;
	skips_ = true;
	writer_.reset();
	pong::say(why);
	if (settings_.last <= 0)
		queue_.give_up();
}

void Recorder::tell_what_is_left_out()
{
	if (told_ || left_out_ == 0)
		return;
	told_ = true;
	pong::say(settings_.path + ": the disk is too slow: pairs are left out of the recording, and counted");
}

void Recorder::write_all()
{
	// Started by a thread with real-time priority it would have that too.
	const sched_param usual = {};
	pthread_setschedparam(pthread_self(), SCHED_OTHER, &usual);
	for (Record record; queue_.take(record);) {
		try {
			if (!skips_ && !write(record))
				end_in_failure(pong::format("%s: cannot write: %s: the recording ends here, after %lld "
							    "pairs",
							    writer_->path().c_str(), writer_->error().c_str(),
							    static_cast<long long>(pairs_written_)));
		} catch (const pong::Failure &failure) {
			end_in_failure(failure.what());
		}
		if (record.ends_release)
			end_file(record.utime);
		queue_.drop();
		tell_what_is_left_out();
	}
}

std::string Recorder::finish()
{
	queue_.close();
	thread_.join();
	if (settings_.last > 0)
		return files_ ? "" : "nothing was recorded: nobody asked to save the last seconds";
	if (failed_)
		return "";
	if (!begun_)
		write_header(utime_);
	std::string text = pong::format("%s: %lld pairs, %.1f MB", settings_.path.c_str(),
					static_cast<long long>(pairs_written_), megabytes(writer_->bytes()));
	if (left_out_ || messages_left_out_)
		text += pong::format("; %lld pairs and %lld messages left out: the disk was too slow",
				     static_cast<long long>(left_out_), static_cast<long long>(messages_left_out_));
	return text;
}

} // namespace track
