#include "usb_port.hpp"

#include <algorithm>
#include <cmath>

#include "host_clock.hpp"
#include "program.hpp"

namespace pong
{

namespace
{

// Between two requests for the status, each of which times the clock: every 100 ms, so that the fit sees 10 s.
constexpr int64_t ASK_EVERY_NS = 100'000'000;
constexpr int64_t SETTLE_EVERY_NS = 20'000'000;
constexpr int64_t SETTLE_PATIENCE_NS = 5'000'000'000;
constexpr double READ_AT_MOST = 0.02; // s, so that the next request is not late

uint32_t ticks_of(double seconds)
{
	return static_cast<uint32_t>(std::llround(seconds * PONG_TRIGGER_TICKS_PER_SECOND));
}

// The microcontroller's own limits, in words.
void check_limits(const Settings &settings)
{
	const double tick = 1.0 / PONG_TRIGGER_TICKS_PER_SECOND, shortest = PONG_TRIGGER_MIN_TICKS * tick;
	const double period = period_of(settings), light = exposure_of(settings);
	if (period < PONG_TRIGGER_MIN_PERIOD * tick || period > PONG_TRIGGER_MAX_PERIOD * tick)
		throw UsageError(format("the microcontroller makes %g to %g pulses a second, not %g",
					1 / (PONG_TRIGGER_MAX_PERIOD * tick), 1 / (PONG_TRIGGER_MIN_PERIOD * tick),
					settings.rate));
	if (std::min(settings.width, light) < shortest || period - std::max(settings.width, light) < shortest)
		throw UsageError(format("the microcontroller needs %g s between two edges", shortest));
}

pong_trigger_settings to_ticks(const Settings &settings)
{
	const double period = PONG_TRIGGER_TICKS_PER_SECOND / settings.rate;
	pong_trigger_settings ticks = {};
	ticks.period_ticks = static_cast<uint32_t>(period);
	ticks.period_fraction = static_cast<uint32_t>((period - ticks.period_ticks) * 0x1p32);
	ticks.width_ticks = ticks_of(settings.width);
	ticks.light_ticks = ticks_of(exposure_of(settings));
	ticks.count = static_cast<uint32_t>(settings.count);
	ticks.active_low = settings.active_low;
	return ticks;
}

} // namespace

UsbPort::UsbPort(const std::string &serial) : device_(serial)
{
	check_version();
}

UsbPort::~UsbPort()
{
	try {
		stop();
	} catch (const Failure &) {
		// Unplugged: it has no power, or stops by itself for want of a host.
	}
}

void UsbPort::check_version()
{
	pong_trigger_info info;
	device_.fetch(PONG_TRIGGER_INFO, &info, sizeof info);
	if (info.version != PONG_TRIGGER_VERSION)
		throw Failure(
			format("the trigger's firmware speaks version %d of the protocol, this program version %d: "
			       "make flash",
			       info.version, PONG_TRIGGER_VERSION));
}

void UsbPort::write_label(pong_trigger_label which, const std::string &text)
{
	device_.send(PONG_TRIGGER_LABEL, which, text.data(), text.size(),
		     "this label: it takes 1 to 16 printable characters");
}

// Asks for the status, which times the clock and tells the device that we live.
void UsbPort::ask()
{
	const int64_t sent = monotonic_ns();
	device_.fetch(PONG_TRIGGER_STATUS, &status_, sizeof status_);
	clock_.add(sent, monotonic_ns(), status_.now);
	asked_ = sent;
}

// What a program that died has left in the endpoint.
void UsbPort::drain()
{
	pong_trigger_pulse old[PONG_TRIGGER_PULSES_PER_PACKET];
	while (device_.read_pulses(old, 5))
		;
}

void UsbPort::settle()
{
	const int64_t give_up = monotonic_ns() + SETTLE_PATIENCE_NS;
	while (!clock_.settled() && monotonic_ns() < give_up && !stop_requested()) {
		pong_trigger_pulse none[PONG_TRIGGER_PULSES_PER_PACKET];
		device_.read_pulses(none, SETTLE_EVERY_NS / 1'000'000);
		ask();
	}
	if (!clock_.settled() && !stop_requested())
		say("the trigger's clock cannot be fitted yet: its pulses are not published until it is");
}

void UsbPort::start(const Settings &settings)
{
	check_limits(settings);
	settings_ = settings;
	device_.send(PONG_TRIGGER_STOP, 0, nullptr, 0, "to stop");
	drain();
	const pong_trigger_settings ticks = to_ticks(settings);
	device_.send(PONG_TRIGGER_SETTINGS, PONG_TRIGGER_VERSION, &ticks, sizeof ticks, "these settings");
	settle();
	running_ = true;
	device_.send(PONG_TRIGGER_START, settings.start_on_edge ? PONG_TRIGGER_START_ON_EDGE : PONG_TRIGGER_START_NOW,
		     nullptr, 0, "to start");
	received_ = 0;
	ask();
}

void UsbPort::read(double seconds, std::vector<Pulse> *pulses)
{
	pong_trigger_pulse packet[PONG_TRIGGER_PULSES_PER_PACKET];
	const double patience = std::max(1.0, std::ceil(1000 * std::min(seconds, READ_AT_MOST)));
	const size_t count = device_.read_pulses(packet, static_cast<unsigned>(patience));
	for (size_t i = 0; i < count; i++) {
		const int64_t utime = clock_.settled() ? utime_of(clock_.host_ns(packet[i].tick)) : 0;
		pulses->push_back({packet[i].number, utime, clock_.residual()});
	}
	received_ += static_cast<uint32_t>(count);
}

bool UsbPort::wait(double seconds, std::vector<Pulse> *pulses)
{
	const int64_t until = monotonic_ns() + static_cast<int64_t>(seconds * 1e9);
	const size_t before = pulses->size();
	do {
		if (monotonic_ns() - asked_ >= ASK_EVERY_NS)
			ask();
		if (status_.state == PONG_TRIGGER_RESTING && received_ + status_.unreported >= status_.pulses) {
			if (!settings_.count || status_.pulses < settings_.count)
				throw Failure(format("the trigger has stopped by itself after %u pulses: it had not "
						     "heard from this program for 2 s",
						     status_.pulses));
			return false;
		}
		read(static_cast<double>(until - monotonic_ns()) * 1e-9, pulses);
	} while (pulses->size() == before && monotonic_ns() < until && !stop_requested());
	return true;
}

std::string UsbPort::stop()
{
	if (!running_)
		return "";
	running_ = false;
	device_.send(PONG_TRIGGER_STOP, 0, nullptr, 0, "to stop");
	device_.fetch(PONG_TRIGGER_STATUS, &status_, sizeof status_);
	std::string summary = format("%u pulses, fastest round trip %.0f us, residual of the clock fit %.1f us",
				     status_.pulses, clock_.fastest() * 1e6, clock_.residual() * 1e6);
	if (status_.unreported)
		summary += format(", %u pulses unreported", status_.unreported);
	return summary;
}

} // namespace pong
