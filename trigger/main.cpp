// pongeye-trigger: pulses that fire both cameras.
#include <memory>

#include "gpio_port.hpp"
#include "host_clock.hpp"
#include "options.hpp"
#include "program.hpp"
#include "publisher.hpp"
#include "pwm_port.hpp"
#include "report.hpp"
#include "usb_port.hpp"

namespace
{

struct Arguments {
	pong::Settings settings;
	int polarity = 0, count = 0;
	double seconds = 0;
	std::string gpio, usb, pwm;
	bool on_usb = false;
	std::string lcm_url, name, serial;
};

const char *const SUMMARY = "Makes the pulses that fire both cameras, and publishes when each came (PONGEYE_TRIGGER).";

const char *const EXAMPLE =
	"  $ pongeye-trigger --rate 110 --width 0.001 --count 330 --usb\n"
	"  # utime pulses rate residual_us lateness_us late\n"
	"  1700000001430163 111 109.9839 7.6 - -\n"
	"  1700000002429843 221 109.9835 8.0 - -\n"
	"  1700000003481684 330 109.9836 7.8 - -\n"
	"  pongeye-trigger: 330 pulses, fastest round trip 150 us, residual of the clock fit 7.7 us";

bool parse(int argc, char **argv, Arguments *to)
{
	pong::Options options("pongeye-trigger", SUMMARY, EXAMPLE);
	options.number("--rate", "HZ", "pulses a second", &to->settings.rate, 0.1, 1e5);
	options.number("--width", "S", "how long a pulse lasts", &to->settings.width, 1e-6, 10);
	options.integer("--count", "N", "so many pulses, then end (until stopped)", &to->count, 1, INT32_MAX);
	options.choice("--polarity", {"high", "low"}, "level of a pulse (high)", &to->polarity);
	options.number("--exposure", "S", "how long the cameras expose, and the light burns (as --width)",
		       &to->settings.exposure, 1e-6, 10);
	options.flag("--start-on-edge", "wait for the start input to fall (--usb)", &to->settings.start_on_edge);
	options.number("--seconds", "S", "end after so long (until stopped)", &to->seconds, 1e-3, 1e9);
	options.text("--gpio", "CHIP:LINE,LINE", "by GPIO lines; names or numbers, one line or two", &to->gpio);
	options.optional_text("--usb", "[SERIAL]", "by the microcontroller on USB", &to->usb);
	options.text("--pwm", "CHIP:CHANNEL", "by a PWM channel of /sys/class/pwm", &to->pwm);
	options.text("--lcm-url", "URL", "where to publish (LCM's default)", &to->lcm_url);
	options.text("--write-name", "TEXT", "give the microcontroller a name, then end (--usb)", &to->name);
	options.text("--write-serial", "TEXT", "give it a serial number, then end (--usb)", &to->serial);
	if (!options.parse(argc, argv))
		return false;

	to->on_usb = options.given("--usb");
	if (to->on_usb + options.given("--gpio") + options.given("--pwm") != 1)
		throw pong::UsageError("needs one of --gpio, --usb and --pwm");
	const bool writes = options.given("--write-name") || options.given("--write-serial");
	if (writes && !to->on_usb)
		throw pong::UsageError("--write-name and --write-serial need --usb");
	if (!writes && !(options.given("--rate") && options.given("--width")))
		throw pong::UsageError("needs --rate and --width");
	to->settings.count = to->count;
	to->settings.active_low = to->polarity == 1;
	return true;
}

void write_labels(const Arguments &arguments)
{
	pong::UsbPort port(arguments.usb);
	if (!arguments.name.empty())
		port.write_label(PONG_TRIGGER_NAME, arguments.name);
	if (!arguments.serial.empty())
		port.write_label(PONG_TRIGGER_SERIAL, arguments.serial);
}

std::unique_ptr<pong::Port> make_port(const Arguments &arguments)
{
	if (arguments.on_usb)
		return std::make_unique<pong::UsbPort>(arguments.usb);
	if (!arguments.gpio.empty())
		return std::make_unique<pong::GpioPort>(arguments.gpio);
	return std::make_unique<pong::PwmPort>(arguments.pwm);
}

// Until the pulses are made, the time is over, or Ctrl-C.
void run(const Arguments &arguments, pong::Port *port, pong::Publisher *publisher)
{
	port->start(arguments.settings);
	pong::Report report;
	const int64_t begin = pong::monotonic_ns();
	std::vector<pong::Pulse> pulses;
	for (bool more = true; more && !pong::stop_requested();) {
		if (arguments.seconds > 0 &&
		    static_cast<double>(pong::monotonic_ns() - begin) >= arguments.seconds * 1e9)
			break;
		report.tick();
		pulses.clear();
		more = port->wait(0.1, &pulses);
		for (const pong::Pulse &pulse : pulses) {
			publisher->publish(pulse, arguments.settings.rate);
			report.add(pulse);
		}
	}
	report.tick();
	const std::string summary = port->stop();
	if (!summary.empty())
		pong::say(summary);
}

int body(int argc, char **argv)
{
	Arguments arguments;
	if (!parse(argc, argv, &arguments))
		return 0;
	if (!arguments.name.empty() || !arguments.serial.empty()) {
		write_labels(arguments);
		return 0;
	}
	pong::check_settings(arguments.settings);
	const std::unique_ptr<pong::Port> port = make_port(arguments);
	pong::Publisher publisher(arguments.lcm_url);
	run(arguments, port.get(), &publisher);
	return 0;
}

} // namespace

int main(int argc, char **argv)
{
	return pong::run_program("pongeye-trigger", argc, argv, body);
}
