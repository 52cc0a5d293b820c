#include "lcm_thread.hpp"

#include "program.hpp"

namespace track
{

namespace
{

constexpr int PATIENCE_MS = 100; // how soon the thread sees that it is to end

} // namespace

LcmThread::LcmThread(const std::string &url, const char *when_deaf) : lcm_(url), when_deaf_(when_deaf)
{
	if (!lcm_.good())
		throw pong::Failure("LCM URL " + url + ": LCM cannot open it");
}

LcmThread::~LcmThread()
{
	stop_ = true;
	if (thread_.joinable())
		thread_.join();
}

void LcmThread::start()
{
	thread_ = std::thread([this] { listen(); });
}

void LcmThread::listen()
{
	while (!stop_)
		if (lcm_.handleTimeout(PATIENCE_MS) < 0) {
			pong::say(when_deaf_);
			return;
		}
}

} // namespace track
