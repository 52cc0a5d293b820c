#include "cameras.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <optional>
#include <utility>

#include "aravis_camera.hpp"
#include "clock.hpp"
#include "fifo.hpp"
#include "pairing.hpp"
#include "program.hpp"
#include "realtime.hpp"
#include "seat.hpp"

namespace track
{

namespace
{

using namespace std::chrono_literals;

constexpr auto PATIENCE = 20ms;                       // how long next() waits
constexpr int64_t SILENCE_NS = INT64_C(2000000000);   // without pictures, then the user is told
constexpr double OVERDUE = 0.18, OVERDUE_PERIODS = 3; // s, and periods: a picture that the others show to be missing
constexpr size_t QUEUE = 32;                          // pictures of both cameras: 0.15 s at 110 Hz

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

class CameraSource : public Source
{
public:
	CameraSource(const pong_rig &rig, const CaptureSettings &settings, HearPulse hear)
		: pairing_(settings.rate, [this](pong_side side, const Picture &picture) { give_back(side, picture); }),
		  hear_(std::move(hear))
	{
		for (const pong_side side : {PONG_LEFT, PONG_RIGHT})
			seats_[side] = std::make_unique<Seat>(side, rig.camera[side], settings,
							      [this](pong_side from, const Picture &picture) {
								      return mailbox_.put({from, picture});
							      });
		const double overdue = settings.rate > 0 ? std::max(OVERDUE, OVERDUE_PERIODS / settings.rate) : OVERDUE;
		overdue_ns_ = std::llround(overdue * 1e9);
		heard_ns_ = monotonic_ns();
		make_thread_realtime(TRACKING_PRIORITY);
		lock_memory();
	}

	// First the cameras end, so that nothing comes any more; then what is still here is freed.
	~CameraSource() override
	{
		for (const auto &seat : seats_)
			seat->begin_to_end();
		for (auto &seat : seats_)
			seat.reset();
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

	bool is_live() const override
	{
		return true;
	}

	Dropped dropped() const override
	{
		Dropped dropped;
		dropped.unpaired = pairing_.unpaired();
		for (const auto &seat : seats_) {
			dropped.incomplete += seat->counts().incomplete;
			dropped.late += seat->counts().late;
			dropped.repeated += seat->counts().repeated;
		}
		return dropped;
	}

	Pulses pulses() const override
	{
		return {numbering_.heard(), {numbering_.missed(PONG_LEFT), numbering_.missed(PONG_RIGHT)}};
	}

	CameraHealth health(pong_side side) const override
	{
		return {seats_[side]->state(), seats_[side]->losses()};
	}

private:
	// Wait for one more picture.
	void receive()
	{
		Mailbox::Letter letter;
		const bool received = mailbox_.take(letter, PATIENCE);
		hear_pulses();
		if (received) {
			heard_ns_ = monotonic_ns();
			told_ = false;
			numbering_.see(letter.side, exposure_begin(letter.side, letter.picture.utime));
			pairing_.push(letter.side, letter.picture);
		}
		for (const pong_side side : {PONG_LEFT, PONG_RIGHT})
			seats_[side]->check();
		look_after_cameras();
		look_after_trigger();
	}

	void hear_pulses()
	{
		for (TriggerPulse pulse; hear_ && hear_(pulse);) {
			numbering_.hear(pulse);
			pulse_ns_ = monotonic_ns();
		}
		numbering_.pass_time(unix_ns() / 1000);
	}

	// The trigger's edge, for a picture whose middle of the exposure was at `utime`.
	int64_t exposure_begin(pong_side side, int64_t utime) const
	{
		return utime - seats_[side]->exposure_ns() / 2000;
	}

	// A camera whose pictures stay away while the other's come, or while pulses are heard of. Where both stay away
	// the trigger has stopped.
	void look_after_cameras()
	{
		const std::optional<int64_t> signs[] = {seats_[PONG_LEFT]->last_sign_ns(),
							seats_[PONG_RIGHT]->last_sign_ns()};
		for (const pong_side side : {PONG_LEFT, PONG_RIGHT}) {
			const std::optional<int64_t> own = signs[side], other = signs[1 - side];
			if (own && std::max(other.value_or(0), pulse_ns_) - *own > overdue_ns_)
				seats_[side]->suspect();
		}
	}

	void look_after_trigger()
	{
		const bool ready = seats_[PONG_LEFT]->state() == CameraState::STREAMING &&
				   seats_[PONG_RIGHT]->state() == CameraState::STREAMING;
		if (!ready)
			heard_ns_ = monotonic_ns();
		if (told_ || monotonic_ns() - heard_ns_ < SILENCE_NS)
			return;
		pong::say("both cameras are ready, but no whole picture has come for 2 s: does the trigger run?");
		told_ = true;
	}

	void give_back(pong_side side, const Picture &picture)
	{
		if (seats_[side])
			seats_[side]->give_back(picture.buffer);
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

	Mailbox mailbox_;                            // outlives the cameras, which put pictures into it
	std::array<std::unique_ptr<Seat>, 2> seats_; // by pong_side
	Pairing pairing_;
	HearPulse hear_;
	PulseNumbering numbering_;
	PicturePair pair_; // lent to the caller
	bool has_pair_ = false;
	int64_t overdue_ns_;
	int64_t pulse_ns_ = 0; // when the last pulse was heard of
	int64_t heard_ns_;     // when the last picture came,
	bool told_ = false;    // and whether the user knows that none comes
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
