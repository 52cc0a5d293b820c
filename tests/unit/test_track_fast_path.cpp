// Who sees a pair: the thread of the camera that brought its second picture where it may, else the tracking thread.
#include <functional>
#include <gtest/gtest.h>
#include <memory>
#include <thread>

#include "fast_path.hpp"
#include "owned.hpp"
#include "pictures.hpp"
#include "program.hpp"
#include "rigs.hpp"

namespace track
{

namespace
{

constexpr double RATE = 110;
constexpr int64_t PERIOD = 9091; // us

// Pairs that both cameras' threads bring while somebody waits.
class Cameras : public Source
{
public:
	explicit Cameras(const Picture &picture) : picture_(picture)
	{
	}

	Next next(StereoPair &pair) override
	{
		if (!here)
			return Next::NOTHING_YET;
		if (broken)
			throw pong::Failure("the camera is broken");
		here = false;
		taken_by = std::this_thread::get_id();
		pair = {frame * PERIOD, frame, picture_.image(), picture_.image(), 0};
		return Next::PAIR;
	}

	void wait() override
	{
		while_waiting();
	}

	Dropped dropped() const override
	{
		return {};
	}

	// Both pictures of the next pair, each looked at in a thread. Which one saw the pair's end, if it could.
	std::thread::id bring(FastPath &fast_path)
	{
		frame++;
		here = true;
		std::thread::id last;
		for (const pong_side side : {PONG_LEFT, PONG_RIGHT})
			std::thread([&] {
				last = std::this_thread::get_id();
				if (fast_path.claim(side, frame * PERIOD, picture_.image(), true))
					fast_path.look(side, picture_.image());
			}).join();
		return last;
	}

	int64_t frame = 0;
	bool here = false, broken = false;
	std::thread::id taken_by;
	std::function<void()> while_waiting;

private:
	const Picture &picture_;
};

class FastPathTest : public testing::Test
{
protected:
	FastPathTest() : rig_(test_rig())
	{
		pong_settings_defaults(PONG_BEST, &settings_);
		eye_.reset(pong_eye_new(&rig_, &settings_, nullptr));
		eager_ = std::make_unique<EagerEye>(eye_.get(), RATE);
		fast_path_ = std::make_unique<FastPath>(*eager_, nullptr);
	}

	// The first pair, which no camera's thread may look at.
	void begin()
	{
		fast_path_->begin(cameras_);
		cameras_.bring(*fast_path_);
		EXPECT_EQ(fast_path_->next().next, Next::PAIR);
		EXPECT_EQ(fast_path_->next().next, Next::NOTHING_YET);
	}

	pong_rig rig_;
	pong_settings settings_;
	pong::OwnedEye eye_;
	std::unique_ptr<EagerEye> eager_;
	std::unique_ptr<FastPath> fast_path_;
	const Picture picture_ = Picture(640, 480, 40);
	Cameras cameras_ = Cameras(picture_);
};

TEST_F(FastPathTest, TheLastCamerasThreadSeesThePair)
{
	begin();
	std::thread::id last;
	cameras_.while_waiting = [&] { last = cameras_.bring(*fast_path_); };
	for (int i = 0; i < 3; i++) {
		fast_path_->wait();
		EXPECT_EQ(cameras_.taken_by, last);
		const Seen &seen = fast_path_->next();
		EXPECT_EQ(seen.next, Next::PAIR);
		EXPECT_EQ(seen.pair.frame, cameras_.frame);
		EXPECT_EQ(seen.sight.outcome, PONG_NOTHING);
		EXPECT_GT(seen.published_ns, 0);
		EXPECT_EQ(fast_path_->next().next, Next::NOTHING_YET);
	}
	fast_path_->end();
}

TEST_F(FastPathTest, TheTrackingThreadSeesItWhereItHasTheTurn)
{
	begin();
	cameras_.bring(*fast_path_);
	EXPECT_TRUE(cameras_.here) << "a camera's thread did not wait for the turn, and did not go without";
	const Seen &seen = fast_path_->next();
	EXPECT_EQ(seen.next, Next::PAIR);
	EXPECT_EQ(cameras_.taken_by, std::this_thread::get_id());
	fast_path_->end();
}

TEST_F(FastPathTest, OnePairAtATimeIsSeenAhead)
{
	begin();
	cameras_.while_waiting = [&] {
		cameras_.bring(*fast_path_);
		cameras_.bring(*fast_path_);
	};
	fast_path_->wait();
	EXPECT_EQ(fast_path_->next().pair.frame, 2);
	EXPECT_EQ(fast_path_->next().pair.frame, 3);
	EXPECT_EQ(cameras_.taken_by, std::this_thread::get_id());
	fast_path_->end();
}

TEST_F(FastPathTest, ACamerasThreadsFailureIsTheTrackingThreads)
{
	begin();
	cameras_.broken = true;
	cameras_.while_waiting = [&] { cameras_.bring(*fast_path_); };
	fast_path_->wait();
	EXPECT_THROW(fast_path_->next(), pong::Failure);
	fast_path_->end();
}

TEST_F(FastPathTest, NothingIsSeenAfterTheEnd)
{
	begin();
	fast_path_->end();
	cameras_.bring(*fast_path_);
	EXPECT_TRUE(cameras_.here);
}

} // namespace

} // namespace track
