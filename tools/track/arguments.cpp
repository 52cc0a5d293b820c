#include "arguments.hpp"

#include <unistd.h>

#include "options.hpp"
#include "program.hpp"

namespace track
{

namespace
{

constexpr char SUMMARY[] =
	"Watch two cameras, or a folder of stereo pictures, and publish over LCM where the ball is (PONGEYE_BALL),\n"
	"where and when it can be hit (PONGEYE_PREDICTION), and how the tracker is doing (PONGEYE_STATUS).";

constexpr char EXAMPLE[] = "  $ pongeye-simulate --out pictures --flights 2 --seed 7\n"
			   "  $ pongeye-track --rig pictures/rig.toml --images pictures --output balls.txt\n"
			   "  pongeye-track: 293 pairs, 99 with a ball; 0 pictures dropped (0 without a partner, 0 "
			   "incomplete, 0 too late, "
			   "0 out of order); latency median 0.48 ms, p99 8.39 ms, max 8.39 ms";

} // namespace

bool parse_arguments(int argc, char **argv, Arguments &arguments)
{
	pong::Options options("pongeye-track", SUMMARY, EXAMPLE);
	options.text("--rig", "FILE", "the cameras' calibration, rig.toml (required)", &arguments.rig);
	options.text("--images", "DIR", "read DIR/NAME-left.png, NAME-right.png instead of the cameras",
		     &arguments.images);
	options.number("--fps", "HZ", "with --images: picture number / HZ is its time (default 110, or DIR/times.txt)",
		       &arguments.fps, 1e-3, 1e6);
	options.choice("--profile", {"paper", "best"},
		       "the published method to the letter, or what measures best (default)", &arguments.profile);
	options.text("--lcm-url", "URL",
		     "where to publish (default: LCM's own, udpm://239.255.76.67:7667?ttl=0); with --images\n"
		     "                          nothing is published unless this is given; memq:// reaches nobody",
		     &arguments.lcm_url);
	options.text("--output", "FILE", "write a table with one row a pair; - is stdout", &arguments.output);
	options.flag("--live", "print the live table on stderr (default where that is a terminal)", &arguments.live);
	options.number("--seconds", "S", "stop after S seconds", &arguments.seconds, 1e-3, 1e9);
	options.flag("--list", "list the cameras that can be reached and what they are set to, and exit",
		     &arguments.list);
	if (!options.parse(argc, argv))
		return false;
	if (arguments.rig.empty() && !arguments.list)
		throw pong::UsageError("--rig FILE is needed: the cameras' calibration");
	if (options.given("--fps") && arguments.images.empty())
		throw pong::UsageError("--fps goes with --images; cameras take their times themselves");
	arguments.publish = arguments.images.empty() || options.given("--lcm-url");
	arguments.live = arguments.live || isatty(STDERR_FILENO);
	return true;
}

} // namespace track
