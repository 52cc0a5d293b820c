#include "cameras.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <thread>
#include <utility>

#include "aravis_camera.hpp"
#include "clock.hpp"
#include "fifo.hpp"
#include "pairing.hpp"
#include "program.hpp"

namespace track
{

namespace
{

using namespace std::chrono_literals;

constexpr auto PATIENCE = 100ms;                    // how long next() waits
constexpr auto CLOCK_INTERVAL = 1s;                 // between comparisons of the clocks
constexpr int64_t SILENCE_NS = INT64_C(2000000000); // without pictures, then the user is told
constexpr int TRACKING_PRIORITY = 9;                // below the cameras' threads
constexpr size_t QUEUE = 32;                        // pictures of both cameras: 0.15 s at 110 Hz

// Hands pictures from the cameras' threads to the one that tracks.
class Mailbox
{
public:
	struct Letter {
		pong_side side;
		Picture picture;
	};

	// False where it is full.
	bool put(const Letter &letter)
	{
		{
			const std::lock_guard<std::mutex> lock(mutex_);
			if (letters_.full())
				return false;
			letters_.push(letter);
		}
		arrived_.notify_one();
		return true;
	}

	// False where none comes in time.
	bool take(Letter &letter, std::chrono::milliseconds patience)
	{
		std::unique_lock<std::mutex> lock(mutex_);
		if (!arrived_.wait_for(lock, patience, [this] { return !letters_.empty(); }))
			return false;
		letter = letters_.pop();
		return true;
	}

private:
	std::mutex mutex_;
	std::condition_variable arrived_;
	Fifo<Letter, QUEUE> letters_;
};

// Calls a function again and again in a thread of its own.
class Ticker
{
public:
	template<class Function>
	Ticker(std::chrono::milliseconds interval, Function function)
		: thread_([this, interval, function] {
			  std::unique_lock<std::mutex> lock(mutex_);
			  while (!wake_.wait_for(lock, interval, [this] { return stop_; }))
				  function();
		  })
	{
	}

	~Ticker()
	{
		{
			const std::lock_guard<std::mutex> lock(mutex_);
			stop_ = true;
		}
		wake_.notify_one();
		thread_.join();
	}

private:
	std::mutex mutex_;
	std::condition_variable wake_;
	bool stop_ = false;
	std::thread thread_;
};

class CameraSource : public Source
{
public:
	CameraSource(const pong_rig &rig, const CaptureSettings &settings, HearPulse hear)
		: pairing_(settings.rate, [this](pong_side side, const Picture &picture) { give_back(side, picture); }),
		  hear_(std::move(hear))
	{
		for (const pong_side side : {PONG_LEFT, PONG_RIGHT})
			cameras_[side] = std::make_unique<Camera>(side, rig.camera[side], settings,
								  [this](pong_side from, const Picture &picture) {
									  return mailbox_.put({from, picture});
								  });
		for (const auto &camera : cameras_)
			camera->start();
		heard_ns_[PONG_LEFT] = heard_ns_[PONG_RIGHT] = monotonic_ns();
		clock_reader_ = std::make_unique<Ticker>(CLOCK_INTERVAL, [this] {
			for (const auto &camera : cameras_)
				camera->read_clock();
		});
		make_thread_realtime(TRACKING_PRIORITY);
	}

	// First the cameras end, so that nothing comes any more; then what is still here is freed.
	~CameraSource() override
	{
		clock_reader_.reset();
		end_cameras();
		give_back_pair();
		pairing_.clear();
		for (Mailbox::Letter letter; mailbox_.take(letter, 0ms);)
			give_back(letter.side, letter.picture);
	}

	Next next(StereoPair &pair) override
	{
		give_back_pair();
		has_pair_ = pairing_.pop(pair_);
		if (!has_pair_) {
			receive();
			has_pair_ = pairing_.pop(pair_);
		}
		if (!has_pair_)
			return Next::NOTHING_YET;
		const Picture &left = pair_.picture[PONG_LEFT], &right = pair_.picture[PONG_RIGHT];
		const int64_t frame = numbering_.frame(exposure_begin(PONG_LEFT, pair_.utime), pair_.frame);
		pair = {pair_.utime, frame, image_of(left.buffer), image_of(right.buffer),
			std::max(left.arrival_ns, right.arrival_ns)};
		return Next::PAIR;
	}

	Dropped dropped() const override
	{
		Dropped dropped;
		dropped.unpaired = pairing_.unpaired();
		for (const auto &camera : cameras_) {
			dropped.incomplete += camera->incomplete();
			dropped.late += camera->late();
		}
		return dropped;
	}

	Pulses pulses() const override
	{
		return {numbering_.heard(), {numbering_.missed(PONG_LEFT), numbering_.missed(PONG_RIGHT)}};
	}

private:
	// Both at once: a lost camera is waited for by Aravis, for 6 s.
	void end_cameras()
	{
		std::thread right([this] { cameras_[PONG_RIGHT].reset(); });
		cameras_[PONG_LEFT].reset();
		right.join();
	}

	// Wait for one more picture.
	void receive()
	{
		Mailbox::Letter letter;
		const bool received = mailbox_.take(letter, PATIENCE);
		hear_pulses();
		if (received) {
			heard_ns_[letter.side] = monotonic_ns();
			told_[letter.side] = false;
			numbering_.see(letter.side, exposure_begin(letter.side, letter.picture.utime));
			pairing_.push(letter.side, letter.picture);
		}
		for (const pong_side side : {PONG_LEFT, PONG_RIGHT})
			check_camera(side);
	}

	void hear_pulses()
	{
		for (TriggerPulse pulse; hear_ && hear_(pulse);)
			numbering_.hear(pulse);
		numbering_.pass_time(unix_ns() / 1000);
	}

	// The trigger's edge, for a picture whose middle of the exposure was at `utime`.
	int64_t exposure_begin(pong_side side, int64_t utime) const
	{
		return utime - cameras_[side]->exposure_ns() / 2000;
	}

	// Whether pictures still come, and if not, why.
	void check_camera(pong_side side)
	{
		const Camera &camera = *cameras_[side];
		if (camera.lost())
			throw pong::Failure(camera.name() + ": lost: it no longer answers");
		if (told_[side] || monotonic_ns() - heard_ns_[side] < SILENCE_NS)
			return;
		pong::say(camera.name() + ": ready, but no whole picture has come for 2 s: does the trigger run?");
		told_[side] = true;
	}

	void give_back(pong_side side, const Picture &picture)
	{
		if (cameras_[side])
			cameras_[side]->give_back(picture.buffer);
		else
			free_buffer(picture.buffer);
	}

	void give_back_pair()
	{
		if (has_pair_)
			for (const pong_side side : {PONG_LEFT, PONG_RIGHT})
				give_back(side, pair_.picture[side]);
		has_pair_ = false;
	}

	Mailbox mailbox_;                                // outlives the cameras, which put pictures into it
	std::array<std::unique_ptr<Camera>, 2> cameras_; // by pong_side
	Pairing pairing_;
	HearPulse hear_;
	PulseNumbering numbering_;
	PicturePair pair_; // lent to the caller
	bool has_pair_ = false;
	int64_t heard_ns_[2];           // by pong_side: when the last picture came
	bool told_[2] = {false, false}; // and whether the user knows that none comes
	std::unique_ptr<Ticker> clock_reader_;
};

void check_ids(const pong_rig &rig)
{
	const char *const names[] = {"left", "right"};
	for (const pong_side side : {PONG_LEFT, PONG_RIGHT})
		if (!*rig.camera[side].id)
			throw pong::Failure(
				pong::format("the rig names no %s camera: add camera = \"address or id\" to [%s] "
					     "in rig.toml, or give --images DIR",
					     names[side], names[side]));
	if (strcmp(rig.camera[PONG_LEFT].id, rig.camera[PONG_RIGHT].id) == 0)
		throw pong::Failure(pong::format("the rig names the same camera, %s, for left and right",
						 rig.camera[PONG_LEFT].id));
}

} // namespace

std::unique_ptr<Source> open_cameras(const pong_rig &rig, const CaptureSettings &settings, HearPulse hear)
{
	check_ids(rig);
	return std::make_unique<CameraSource>(rig, settings, std::move(hear));
}

} // namespace track
