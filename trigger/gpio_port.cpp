#include "gpio_port.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <ctime>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <sys/eventfd.h>
#include <sys/mman.h>
#include <unistd.h>

#include "host_clock.hpp"
#include "program.hpp"

namespace pong
{

namespace
{

constexpr int64_t LEAD_NS = 20'000'000;        // until the first pulse
constexpr int64_t LONGEST_NAP_NS = 50'000'000; // after which a thread looks whether it is to stop

// Signals are for the main thread; the scheduler and the memory, as far as we may, for this one.
void become_real_time()
{
	sigset_t all;
	sigfillset(&all);
	pthread_sigmask(SIG_BLOCK, &all, nullptr);
	sched_param priority = {};
	priority.sched_priority = 80;
	if (const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority))
		say(std::string("no real-time priority (") + strerror(error) +
		    "): pulses may come late; see docs/synchronization.md");
	if (mlockall(MCL_CURRENT))
		say(std::string("cannot lock the memory (") + strerror(errno) + "): pulses may come late");
}

} // namespace

GpioPort::GpioPort(const std::string &text) : spec_(parse_gpio(text)), event_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC))
{
}

GpioPort::~GpioPort()
{
	stop();
	close(event_);
}

void GpioPort::start(const Settings &settings)
{
	if (settings.start_on_edge)
		throw UsageError("--gpio cannot wait for an outside edge: use --usb");
	settings_ = settings;
	lines_ = std::make_unique<GpioLines>(spec_, settings.active_low);
	thread_ = std::thread(&GpioPort::make_pulses, this);
}

void GpioPort::sleep_until(int64_t moment) const
{
	for (int64_t now = monotonic_ns(); now < moment && !stopping_; now = monotonic_ns()) {
		const int64_t until = std::min(moment, now + LONGEST_NAP_NS);
		const timespec time = {static_cast<time_t>(until / 1'000'000'000),
				       static_cast<long>(until % 1'000'000'000)};
		clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &time, nullptr);
	}
}

bool GpioPort::set(bool active)
{
	const bool good = lines_->set(active);
	if (!good)
		error_ = errno;
	return good;
}

void GpioPort::wake()
{
	const uint64_t one = 1;
	// Full only after 2^64 - 2 pulses unseen: then wait() is awake anyway.
	if (write(event_, &one, sizeof one) < 0)
		return;
}

// The edge lies somewhere between the two looks at the clock. False where the pulse was not made.
bool GpioPort::make_pulse(int64_t due, int64_t number)
{
	sleep_until(due);
	if (stopping_)
		return false;
	const int64_t before = monotonic_ns();
	if (!set(true))
		return false;
	const int64_t after = monotonic_ns(), edge = before + (after - before) / 2;
	const double late = static_cast<double>(edge - due) * 1e-9;
	made_ = number;
	queue_.push({number, utime_of(edge), 0, late});
	wake();
	const int64_t end = edge + std::llround(settings_.width * 1e9);
	sleep_until(end);
	const bool good = set(false);
	const double longer = stopping_ ? 0 : static_cast<double>(monotonic_ns() - end) * 1e-9;
	lateness_.add(std::max(late, longer));
	return good;
}

// Each edge is due at a multiple of the period after the first, whatever happened before: lateness does not add up.
// Where a whole period has been overslept its pulse is left out; two pulses at once would help nobody.
void GpioPort::make_pulses()
{
	become_real_time();
	const double period = period_of(settings_) * 1e9;
	const int64_t first = monotonic_ns() + LEAD_NS;
	int64_t number = 0;
	for (int64_t place = 0; !settings_.count || number < settings_.count; place++) {
		const int64_t due = first + std::llround(period * static_cast<double>(place));
		if (static_cast<double>(monotonic_ns() - due) > period) {
			skipped_++;
			continue;
		}
		if (!make_pulse(due, ++number))
			break;
	}
	done_ = true;
	wake();
}

bool GpioPort::wait(double seconds, std::vector<Pulse> *pulses)
{
	const bool done = done_; // before looking, so that the last pulse is seen
	Pulse pulse;
	pollfd woken = {event_, POLLIN, 0};
	if (!done)
		poll(&woken, 1, static_cast<int>(std::ceil(seconds * 1000)));
	uint64_t count;
	if (read(event_, &count, sizeof count) < 0 && errno != EAGAIN)
		throw Failure(std::string("eventfd: ") + strerror(errno));
	while (queue_.pop(&pulse))
		pulses->push_back(pulse);
	if (error_)
		throw Failure("cannot set the GPIO lines of " + spec_.chip + ": " + strerror(error_));
	return !done;
}

std::string GpioPort::stop()
{
	if (!thread_.joinable())
		return "";
	stopping_ = true;
	thread_.join();
	lines_.reset();
	return format("%lld pulses, %lld late by more than %g us, %lld left out, latest %.1f us; of the later edge of "
		      "each:\n",
		      static_cast<long long>(made_), static_cast<long long>(lateness_.late()), Lateness::LATE * 1e6,
		      static_cast<long long>(skipped_), lateness_.worst() * 1e6) +
	       lateness_.text();
}

} // namespace pong
