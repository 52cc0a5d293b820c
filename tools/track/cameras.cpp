#include "cameras.hpp"

#include <algorithm>
#include <array>
#include <atomic>
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

constexpr auto PATIENCE = 20ms;                       // how long wait() waits
constexpr int64_t SILENCE_NS = INT64_C(2000000000);   // without pictures, then the user is told
constexpr double OVERDUE = 0.18, OVERDUE_PERIODS = 3; // s, and periods: a picture that the others show to be missing
constexpr size_t QUEUE = 16;                          // pictures of a camera: 0.15 s at 110 Hz

struct Letter {
	pong_side side;
	Picture picture;
};

// Hands pictures from the cameras' threads to the one that tracks.
class Mailbox
{
public:
	// Whether there is room for one more picture of a camera. It is still there when that camera's thread puts one.
	bool has_room(pong_side side)
	{
		const std::lock_guard<std::mutex> lock(mutex_);
		return !pictures_[side].full();
	}

	void put(pong_side side, const Picture &picture)
	{
		const std::lock_guard<std::mutex> lock(mutex_);
		pictures_[side].push(picture);
	}

	// Wake whoever waits, or will.
	void ring()
	{
		{
			const std::lock_guard<std::mutex> lock(mutex_);
			rung_ = true;
		}
		arrived_.notify_one();
	}

	// Wait for the ring, but not for long.
	void wait()
	{
		std::unique_lock<std::mutex> lock(mutex_);
		arrived_.wait_for(lock, PATIENCE, [this] { return rung_; });
		rung_ = false;
	}

	// False where none is there.
	bool take(Letter &letter)
	{
		const std::lock_guard<std::mutex> lock(mutex_);
		if (empty())
			return false;
		letter.side = pictures_[PONG_LEFT].empty() ? PONG_RIGHT : PONG_LEFT;
		letter.picture = pictures_[letter.side].pop();
		return true;
	}

private:
	bool empty() const
	{
		return pictures_[PONG_LEFT].empty() && pictures_[PONG_RIGHT].empty();
	}

	std::mutex mutex_;
	std::condition_variable arrived_;
	bool rung_ = false;
	Fifo<Picture, QUEUE> pictures_[2]; // by pong_side
};

class CameraSource : public Source
{
public:
	CameraSource(const pong_rig &rig, const CaptureSettings &settings, HearPulse hear, Onlooker *onlooker)
		: onlooker_(onlooker),
		  pairing_(settings.rate, [this](pong_side side, const Picture &picture) { release(side, picture); }),
		  hear_(std::move(hear))
	{
		lock_memory();
		for (const pong_side side : {PONG_LEFT, PONG_RIGHT})
			seats_[side] = std::make_unique<Seat>(
				side, rig.camera[side], settings,
				[this](pong_side from, const Picture &picture) { return arrive(from, picture); });
		const double overdue = settings.rate > 0 ? std::max(OVERDUE, OVERDUE_PERIODS / settings.rate) : OVERDUE;
		overdue_ns_ = std::llround(overdue * 1e9);
		heard_ns_ = monotonic_ns();
		make_thread_realtime(TRACKING_PRIORITY);
	}

	// First the cameras end, so that nothing comes any more; then what is still here is freed.
	~CameraSource() override
	{
		for (const auto &seat : seats_)
			seat->begin_to_end();
		for (auto &seat : seats_)
			seat.reset();
		onlooker_ = nullptr;
		give_back_lent();
		if (has_pair_)
			for (const pong_side side : {PONG_LEFT, PONG_RIGHT})
				give_back(side, pair_.picture[side]);
		pairing_.clear();
		while (!alone_.empty()) {
			const Letter letter = alone_.pop();
			give_back(letter.side, letter.picture);
		}
		for (Letter letter; mailbox_.take(letter);)
			give_back(letter.side, letter.picture);
	}

	Next next(StereoPair &pair) override
	{
		give_back_lent();
		if (!has_pair_ && alone_.empty())
			receive();
		// In the order in which they were looked at.
		if (!alone_.empty())
			return lend_alone(pair);
		return has_pair_ ? lend_pair(pair) : Next::NOTHING_YET;
	}

	void wait() override
	{
		mailbox_.wait();
	}

	bool is_live() const override
	{
		return true;
	}

	Dropped dropped() const override
	{
		Dropped dropped;
		dropped.unpaired = pairing_.unpaired();
		dropped.miscounted = pairing_.miscounted();
		for (const auto &seat : seats_) {
			dropped.unpaired += seat->counts().undated;
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
	// In the camera's thread. While the onlooker still looks, or waits for the partner of what it has looked at,
	// the tracking thread is not woken: it would find nothing to do. It looks around by itself soon enough.
	bool arrive(pong_side side, const Picture &picture)
	{
		if (!mailbox_.has_room(side))
			return false;
		const pong_image image = image_of(picture.buffer);
		const bool is_first = held_++ == 0;
		const bool claimed = onlooker_ && onlooker_->claim(side, picture.utime, image, is_first);
		mailbox_.put(side, picture);
		if (!claimed || onlooker_->look(side, image))
			mailbox_.ring();
		return true;
	}

	// Where the cameras' counters object, one of their clocks may be wrong by a whole period.
	Next lend_pair(StereoPair &pair)
	{
		const Picture &left = pair_.picture[PONG_LEFT], &right = pair_.picture[PONG_RIGHT];
		const int64_t frame =
			pair_.miscounted ? 0 : numbering_.frame(exposure_begin(PONG_LEFT, pair_.utime), pair_.frame);
		pair = {pair_.utime, frame, image_of(left.buffer), image_of(right.buffer),
			std::max(left.arrival_ns, right.arrival_ns)};
		for (const pong_side side : {PONG_LEFT, PONG_RIGHT})
			pair.exposure_us[side] = exposure_us(side);
		lent_[PONG_LEFT] = left;
		lent_[PONG_RIGHT] = right;
		has_pair_ = false;
		if (!pair_.miscounted)
			return Next::PAIR;
		for (const auto &seat : seats_)
			seat->doubt_clock();
		return Next::ALONE;
	}

	Next lend_alone(StereoPair &pair)
	{
		const Letter letter = alone_.pop();
		pair = {};
		pair.utime = letter.picture.utime;
		(letter.side == PONG_LEFT ? pair.left : pair.right) = image_of(letter.picture.buffer);
		pair.arrival_ns = letter.picture.arrival_ns;
		pair.exposure_us[letter.side] = exposure_us(letter.side);
		lent_[letter.side] = letter.picture;
		return Next::ALONE;
	}

	// A picture that finds no partner.
	void release(pong_side side, const Picture &picture)
	{
		if (onlooker_ && !alone_.full() && onlooker_->holds(side, image_of(picture.buffer)))
			alone_.push({side, picture});
		else
			give_back(side, picture);
	}

	// Take the pictures that are here, until there is a pair.
	void receive()
	{
		hear_pulses();
		Letter letter;
		while (!(has_pair_ = pairing_.pop(pair_)) && mailbox_.take(letter)) {
			heard_ns_ = monotonic_ns();
			told_ = false;
			numbering_.see(letter.side, exposure_begin(letter.side, letter.picture.utime));
			pairing_.push(letter.side, letter.picture);
		}
		if (has_pair_ || !alone_.empty())
			return;
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

	int32_t exposure_us(pong_side side) const
	{
		return static_cast<int32_t>(seats_[side]->exposure_ns() / 1000);
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
		held_--;
		if (seats_[side])
			seats_[side]->give_back(picture.buffer);
		else
			free_buffer(picture.buffer);
	}

	void give_back_lent()
	{
		for (const pong_side side : {PONG_LEFT, PONG_RIGHT})
			if (lent_[side].buffer)
				give_back(side, lent_[side]);
		lent_[PONG_LEFT] = lent_[PONG_RIGHT] = {};
	}

	Mailbox mailbox_;                            // outlives the cameras, which put pictures into it
	std::atomic<int> held_{0};                   // pictures that were not given back yet
	Onlooker *onlooker_;                         // and so does this one; null: nobody
	std::array<std::unique_ptr<Seat>, 2> seats_; // by pong_side
	Pairing pairing_;
	HearPulse hear_;
	PulseNumbering numbering_;
	PicturePair pair_; // the next one,
	bool has_pair_ = false;
	Fifo<Letter, 2> alone_; // and what comes before it
	Picture lent_[2] = {};  // to the caller, by pong_side
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

std::unique_ptr<Source> open_cameras(const pong_rig &rig, const CaptureSettings &settings, HearPulse hear,
				     Onlooker *onlooker)
{
	check_ids(rig);
	return std::make_unique<CameraSource>(rig, settings, std::move(hear), onlooker);
}

} // namespace track
