#include "pwm_port.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include "program.hpp"

namespace pong
{

namespace
{

constexpr int UDEV_PATIENCE = 20; // times 50 ms, until udev has given a new channel's files to their group

bool is_number(const std::string &text)
{
	return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

bool try_write(const std::string &path, const std::string &text)
{
	const int file = open(path.c_str(), O_WRONLY | O_CLOEXEC | O_TRUNC);
	if (file < 0)
		return false;
	const bool written = write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
	const int error = errno;
	close(file);
	errno = error;
	return written;
}

void write_file(const std::string &path, const std::string &text)
{
	if (!try_write(path, text))
		throw Failure("cannot write " + text + " into " + path + ": " + strerror(errno));
}

char first_of(const std::string &path)
{
	char text = 0;
	const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
	if (file < 0 || read(file, &text, 1) != 1)
		text = 0;
	close(file);
	return text;
}

} // namespace

PwmPort::PwmPort(const std::string &text)
{
	const size_t colon = text.rfind(':');
	number_ = colon == std::string::npos ? "" : text.substr(colon + 1);
	if (colon == 0 || !is_number(number_))
		throw UsageError("--pwm needs CHIP:CHANNEL, not '" + text + "'");
	const std::string chip = text.substr(0, colon);
	chip_ = "/sys/class/pwm/" + std::string(is_number(chip) ? "pwmchip" : "") + chip;
	channel_ = chip_ + "/pwm" + number_;
	if (access(chip_.c_str(), F_OK))
		throw Failure("there is no PWM chip " + chip_);
	if (first_of(channel_ + "/enable") == '1')
		throw Failure(channel_ + " is in use: it is enabled already");
}

PwmPort::~PwmPort()
{
	stop();
}

void PwmPort::export_channel(const std::string &number)
{
	if (access(channel_.c_str(), F_OK) == 0)
		return;
	write_file(chip_ + "/export", number);
	exported_ = true;
	for (int i = 0; i < UDEV_PATIENCE && access((channel_ + "/enable").c_str(), W_OK); i++)
		poll(nullptr, 0, 50);
}

// A duty cycle may not be longer than the period at any moment, so it is zero while the period changes.
void PwmPort::start(const Settings &settings)
{
	if (settings.count || settings.start_on_edge)
		throw UsageError("--pwm can neither count pulses nor wait for an outside edge: use --usb");
	export_channel(number_);
	running_ = true;
	write_file(channel_ + "/duty_cycle", "0");
	write_file(channel_ + "/period", std::to_string(std::llround(period_of(settings) * 1e9)));
	write_file(channel_ + "/polarity", settings.active_low ? "inversed" : "normal");
	write_file(channel_ + "/duty_cycle", std::to_string(std::llround(settings.width * 1e9)));
	write_file(channel_ + "/enable", "1");
}

bool PwmPort::wait(double seconds, std::vector<Pulse> *)
{
	poll(nullptr, 0, static_cast<int>(std::ceil(seconds * 1000)));
	return true;
}

// Duty cycle zero first: it is the inactive level, which a disabled channel need not have.
std::string PwmPort::stop()
{
	if (running_) {
		try_write(channel_ + "/duty_cycle", "0");
		try_write(channel_ + "/enable", "0");
	}
	if (exported_)
		try_write(chip_ + "/unexport", number_);
	running_ = exported_ = false;
	return "";
}

} // namespace pong
