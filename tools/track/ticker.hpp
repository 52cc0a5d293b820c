// Calls a function again and again in a thread of its own.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace track
{

class Ticker
{
public:
	template<class Function>
	Ticker(std::chrono::milliseconds interval, Function function)
		: thread_([this, interval, function] {
			  std::unique_lock<std::mutex> lock(mutex_);
			  while (!wake_.wait_for(lock, interval, [this] { return stop_; })) {
				  lock.unlock();
				  function();
				  lock.lock();
			  }
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

} // namespace track
