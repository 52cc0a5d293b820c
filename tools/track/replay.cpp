#include "replay.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "big_endian.hpp"
#include "clock.hpp"
#include "program.hpp"

namespace track
{

namespace
{

FILE *open_file(const std::string &path)
{
	FILE *file = path == "-" ? fdopen(0, "rb") : fopen(path.c_str(), "rb");
	if (!file)
		throw pong::Failure(path + ": " + strerror(errno));
	return file;
}

// A header is its type's hash, the time, and six texts, each after its length, in which a zero at the end counts.
// The generated decoder believes these lengths, negative ones too: look at them first.
bool is_header(const std::vector<uint8_t> &data)
{
	constexpr int TEXTS = 6;
	size_t place = 8 + 8;
	for (int text = 0; text < TEXTS; text++) {
		if (data.size() < place + 4)
			return false;
		const uint32_t length = load32(data.data() + place);
		place += 4;
		if (length < 1 || length > data.size() - place)
			return false;
		place += length;
	}
	return true;
}

} // namespace

Replay::Replay(const std::string &path) : Replay(open_file(path), path == "-" ? "standard input" : path)
{
}

Replay::Replay(FILE *file, const std::string &name) : name_(name), file_(file), reader_(file)
{
	read_header();
}

// It comes first, or not at all.
void Replay::read_header()
{
	errno = 0;
	const EventReader::Result result = reader_.next(event_);
	if (errno == EISDIR)
		throw pong::Failure(name_ + ": " + strerror(errno));
	if (result != EventReader::Result::EVENT)
		throw pong::Failure(name_ + ": this is no recording: it has not one event of an LCM log");
	has_header_ = event_.channel == "PONGEYE_RECORDING" && take_header();
	pending_ = !has_header_;
	if (has_header_ && header_.what == "messages")
		throw pong::Failure(name_ + ": no pictures to replay: it was made with --record-what messages");
}

bool Replay::take_header()
{
	const std::vector<uint8_t> &data = event_.data;
	return is_header(data) && header_.decode(data.data(), 0, static_cast<int>(data.size())) >= 0;
}

RigText Replay::rig() const
{
	if (!has_header_)
		throw pong::Failure(name_ + ": it does not say which rig it was made with: give --rig rig.toml");
	return {name_ + ", " + header_.rig_name, header_.rig};
}

pong_profile Replay::profile() const
{
	return header_.profile == "paper" ? PONG_PAPER : PONG_BEST;
}

// Whether an event's message is what its channel says. Two pictures that are no pair are alone, too.
bool Replay::decode_pictures(bool alone)
{
	return decode(event_.data, message_) && pictures_of(message_) >= (alone ? 1 : 2) &&
	       message_.number >= (alone ? 0 : 1);
}

bool Replay::take_alone(StereoPair &alone)
{
	if (event_.channel != "PONGEYE_ALONE" || !decode_pictures(true) || !unpacker_.unpack(message_, alone))
		return false;
	alone.arrival_ns = monotonic_ns();
	return true;
}

// False where the event has no pair that can be made a picture of.
bool Replay::take_pair(StereoPair &pair)
{
	if (event_.channel != "PONGEYE_PAIR")
		return false;
	if (!decode_pictures(false)) {
		damaged_++;
		return false;
	}
	if (first_number_ == 0)
		first_number_ = message_.number;
	last_number_ = std::max(last_number_, message_.number);
	if (!unpacker_.unpack(message_, pair))
		return false;
	pair.arrival_ns = monotonic_ns();
	pairs_++;
	return true;
}

Next Replay::next(StereoPair &pair)
{
	for (;;) {
		EventReader::Result result = EventReader::Result::EVENT;
		if (!pending_)
			result = reader_.next(event_);
		pending_ = false;
		if (result != EventReader::Result::EVENT) {
			end(result);
			return Next::END;
		}
		if (take_pair(pair))
			return Next::PAIR;
		if (take_alone(pair))
			return Next::ALONE;
	}
}

// Pairs that were left out, or that are windows into a whole picture that was.
int64_t Replay::missing() const
{
	return first_number_ ? std::max<int64_t>(0, last_number_ - first_number_ + 1 - pairs_ - damaged_) : 0;
}

// What there is to say about a recording that is not as it should be.
void Replay::end(EventReader::Result how)
{
	const auto number = [](int64_t count) { return static_cast<long long>(count); };
	if (how == EventReader::Result::CUT)
		pong::say(name_ + ": cut off in the middle of an event: this is all that there is");
	if (reader_.skipped() || damaged_)
		pong::say(pong::format("%s: damaged: %lld bytes and %lld pairs cannot be read, and were skipped",
				       name_.c_str(), number(reader_.skipped()), number(damaged_)));
	if (missing())
		pong::say(pong::format("%s: %lld pairs are missing: they were left out when it was recorded",
				       name_.c_str(), number(missing())));
	if (pairs_ == 0)
		throw pong::Failure(name_ + ": no pictures to replay: nothing on channel PONGEYE_PAIR");
}

} // namespace track
