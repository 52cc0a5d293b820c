#include "arguments.hpp"

#include <filesystem>
#include <unistd.h>

#include "options.hpp"
#include "program.hpp"
#include "recorder.hpp"

namespace track
{

namespace
{

constexpr char SUMMARY[] =
	"Watch two cameras, a folder of stereo pictures, or a recording, and publish over LCM where the ball is "
	"(PONGEYE_BALL),\n"
	"where and when it can be hit (PONGEYE_PREDICTION), and how the tracker is doing (PONGEYE_STATUS).";

constexpr char EXAMPLE[] = "  $ pongeye-simulate --out pictures --flights 2 --seed 7\n"
			   "  $ pongeye-track --rig pictures/rig.toml --images pictures --output balls.txt\n"
			   "  pongeye-track: 293 pairs, 99 with a ball; 0 pictures dropped (0 without a partner, 0 "
			   "incomplete, 0 too late, "
			   "0 out of order); latency windowed median 0.36 ms, p99 8.39 ms, max 8.39 ms; latency "
			   "searching median 0.48 ms, p99 3.02 ms, max 3.02 ms\n"
			   "\n"
			   "  $ pongeye-track --rig rig.toml --record session.lcm     (Ctrl-C ends it)\n"
			   "  pongeye-track: session.lcm: 402 pairs, 247.2 MB\n"
			   "  $ pongeye-track --replay session.lcm --output table.txt";

// What goes with what.
void check(const pong::Options &options, const Arguments &arguments)
{
	if (arguments.rig.empty() && arguments.replay.empty() && !arguments.list)
		throw pong::UsageError("--rig FILE is needed: the cameras' calibration");
	if (!arguments.images.empty() && !arguments.replay.empty())
		throw pong::UsageError("--images and --replay: the pictures come from one of them");
	if (options.given("--fps") && arguments.images.empty())
		throw pong::UsageError("--fps goes with --images; cameras and recordings have times themselves");
	for (const char *option : {"--record-what", "--record-last"})
		if (options.given(option) && arguments.record.empty())
			throw pong::UsageError(std::string(option) + " goes with --record FILE");
	std::error_code none;
	if (!arguments.record.empty() && std::filesystem::equivalent(arguments.record, arguments.replay, none))
		throw pong::UsageError("--record would overwrite the recording that --replay reads");
}

} // namespace

bool parse_arguments(int argc, char **argv, Arguments &arguments)
{
	pong::Options options("pongeye-track", SUMMARY, EXAMPLE);
	options.text("--rig", "FILE", "the cameras' calibration, rig.toml (required, but for --replay, which has one)",
		     &arguments.rig);
	options.text("--images", "DIR", "read DIR/NAME-left.png, NAME-right.png instead of the cameras",
		     &arguments.images);
	options.text("--replay", "FILE", "read a recording instead of the cameras; - is stdin", &arguments.replay);
	options.number("--fps", "HZ", "with --images: picture number / HZ is its time (default 110, or DIR/times.txt)",
		       &arguments.fps, 1e-3, 1e6);
	options.choice("--profile", {"paper", "best"},
		       "the published method to the letter, or what measures best (default; --replay: the recording's)",
		       &arguments.profile);
	options.text("--lcm-url", "URL",
		     "where to publish (default: LCM's own, udpm://239.255.76.67:7667?ttl=0); with --images\n"
		     "                          and --replay nothing is published unless this is given; memq:// "
		     "reaches nobody",
		     &arguments.lcm_url);
	options.text("--output", "FILE", "write a table with one row a pair; - is stdout", &arguments.output);
	options.text("--record", "FILE",
		     "write pictures and messages, with the rig, into an LCM log, which --replay reads",
		     &arguments.record);
	options.choice("--record-what", record_what_words(),
		       "with --record: whole pictures (default), windows around the ball, or no pictures",
		       &arguments.record_what);
	options.number("--record-last", "S",
		       "with --record: keep the last S seconds in memory; each SIGUSR1, message on PONGEYE_RECORD or\n"
		       "                          Enter writes them into a file of its own, FILE with the time added",
		       &arguments.record_last, 0.1, 3600);
	options.flag("--live", "print the live table on stderr (default where that is a terminal)", &arguments.live);
	options.number("--seconds", "S", "stop after S seconds", &arguments.seconds, 1e-3, 1e9);
	options.flag("--list", "list the cameras that can be reached and what they are set to, and exit",
		     &arguments.list);
	if (!options.parse(argc, argv))
		return false;
	check(options, arguments);
	arguments.profile_given = options.given("--profile");
	arguments.publish = arguments.from_cameras() || options.given("--lcm-url");
	arguments.live = arguments.live || isatty(STDERR_FILENO);
	return true;
}

} // namespace track
