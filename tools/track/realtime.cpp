#include "realtime.hpp"

#include <malloc.h>
#include <mutex>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include "program.hpp"

namespace track
{

namespace
{

constexpr int LARGE_BLOCK = 128 * 1024; // bytes
constexpr size_t STACK = 1024 * 1024;   // bytes

} // namespace

void make_thread_realtime(int priority)
{
	static std::once_flag warned;
	sched_param parameters = {};
	parameters.sched_priority = priority;
	if (pthread_setschedparam(pthread_self(), SCHED_RR, &parameters) != 0)
		std::call_once(warned, [] {
			pong::say(
				"no real-time priority, which this user may not have: under load pictures come later");
		});
}

// With a limit that all later memory counts against, memory would run out sooner: then rather not.
void lock_memory()
{
	// Pictures' buffers, which come and go with a camera, get pages of their own: in a heap they leave holes.
	mallopt(M_MMAP_THRESHOLD, LARGE_BLOCK);
	// A thread's stack is locked whole.
	pthread_attr_t attributes;
	pthread_attr_init(&attributes);
	pthread_attr_setstacksize(&attributes, STACK);
	pthread_setattr_default_np(&attributes);
	pthread_attr_destroy(&attributes);
	rlimit limit;
	const bool unlimited = getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY;
	if (unlimited || geteuid() == 0)
		mlockall(MCL_CURRENT | MCL_FUTURE);
}

} // namespace track
