// Receives LCM's messages in a thread of its own.
#pragma once

#include <atomic>
#include <lcm/lcm-cpp.hpp>
#include <string>
#include <thread>

namespace track
{

// The last member of whoever's handlers it calls, so that it ends first.
class LcmThread
{
public:
	// What to say where LCM brings no more messages. Throws pong::Failure where LCM cannot open the URL.
	LcmThread(const std::string &url, const char *when_deaf);
	~LcmThread();
	LcmThread(const LcmThread &) = delete;
	LcmThread &operator=(const LcmThread &) = delete;

	// To subscribe with, before start().
	lcm::LCM &bus()
	{
		return lcm_;
	}

	void start();

private:
	void listen();

	lcm::LCM lcm_;
	const char *when_deaf_;
	std::atomic<bool> stop_{false};
	std::thread thread_;
};

} // namespace track
