// pongeye-simulate: pictures of a world whose truth is known.

#include <cmath>
#include <cstdio>
#include <cstring>

#include "fault_list.hpp"
#include "folder.hpp"
#include "live.hpp"
#include "options.hpp"
#include "program.hpp"
#include "text_file.hpp"

namespace
{

struct Request {
	std::string folder, scene = "rally", truth, rig, trigger_line, miss, faults;
	bool cameras = false, list_scenes = false;
	int seed = 1, flights = 0, frames = 0;
	double rate = 110;
};

constexpr int default_flights = 10; // written where neither scene nor user says how many

pong::Options options(Request *request)
{
	pong::Options options(
		"pongeye-simulate",
		"Show a ball, rendered with its true position known, to pongeye-track: as a folder of pictures, or as\n"
		"two GigE Vision cameras on loopback (127.0.0.1 left, 127.0.0.2 right).",
		"  $ pongeye-simulate --out pictures --flights 2 --seed 7\n"
		"  pongeye-simulate: 293 frames of scene rally written to pictures\n"
		"  $ ls pictures | head -3\n"
		"  000000-left.png\n"
		"  000000-right.png\n"
		"  000001-left.png\n"
		"  $ pongeye-track --rig pictures/rig.toml --images pictures --fps 110 --output -");
	options.text("--out", "DIR", "write pictures, rig.toml and truth.txt into this folder", &request->folder);
	options.flag("--cameras", "serve two GigE Vision cameras until Ctrl-C", &request->cameras);
	options.text("--scene", "NAME|FILE", "what is to be seen: a built-in scene or a scene.toml (rally)",
		     &request->scene);
	options.flag("--list-scenes", "name the built-in scenes", &request->list_scenes);
	options.integer("--seed", "N", "another number, another world (1)", &request->seed, 0, 1 << 30);
	options.integer("--flights", "N", "end after so many flights, positions or poses", &request->flights, 1,
			1000000);
	options.integer("--frames", "N", "end after so many frames", &request->frames, 1, 100000000);
	options.number("--rate", "HZ", "frames a second (110)", &request->rate, 1, 2000);
	options.number("--fps", "HZ", "the same", &request->rate, 1, 2000);
	options.text("--truth", "FILE|-", "write the true positions here, as the cameras expose (with --cameras)",
		     &request->truth);
	options.text("--rig", "FILE", "write the true rig.toml here (with --cameras)", &request->rig);
	options.text("--trigger-line", "PATH",
		     "expose at the edges that come to this socket, which is made, at --rate (with --cameras)",
		     &request->trigger_line);
	options.text("--miss", "CAMERA:N", "left or right misses every N-th trigger (with --cameras)", &request->miss);
	options.text(
		"--fault", "LIST",
		"what goes wrong, as CAMERA:KIND[=AMOUNT][@BEGIN[+SECONDS]], several apart by commas (with "
		"--cameras).\n"
		"                          CAMERA: left, right, both. KIND: lose=PART, reorder=PART (of the packets),\n"
		"                          miss, truncate (pulses, pictures; =PART of them), freeze, die, held (its\n"
		"                          control, by a dead client), offset=S, drift=PPM (its clock), block=ID (the\n"
		"                          first frame's), miscount (one pulse more). BEGIN: seconds from the first "
		"pulse, flightN or bounceN",
		&request->faults);
	return options;
}

void list_scenes()
{
	for (const sim::BuiltinScene &scene : sim::builtin_scenes())
		printf("%-10s %s\n", scene.name, scene.summary);
}

void check(const Request &request)
{
	if (request.cameras != request.folder.empty())
		throw pong::UsageError("one of --out and --cameras is needed, not both");
	if (!request.cameras && (!request.truth.empty() || !request.rig.empty()))
		throw pong::UsageError("--truth and --rig go with --cameras; --out writes both into its folder");
	if (!request.cameras && (!request.trigger_line.empty() || !request.miss.empty() || !request.faults.empty()))
		throw pong::UsageError("--trigger-line, --miss and --fault go with --cameras");
}

// How many frames the request asks for; 0: no end.
int64_t frames_of(const Request &request, const sim::Scene &scene)
{
	const int board_frames = request.cameras ? static_cast<int>(std::lround(request.rate)) : 1;
	sim::World world(scene, sim::make_rig(scene.rig), static_cast<uint64_t>(request.seed), request.rate,
			 board_frames);
	int flights = request.flights;
	if (!flights && request.frames)
		return request.frames;
	if (!flights && request.cameras)
		return 0;
	if (!flights)
		flights = world.count() ? world.count() : default_flights;
	const auto frames = static_cast<int64_t>(std::ceil(world.end_of(flights) * request.rate));
	return request.frames ? std::min<int64_t>(request.frames, frames) : frames;
}

// "right:10": that camera misses every tenth trigger.
void inject(const std::string &miss, gige::ServerSettings &settings)
{
	char side[6];
	int every, end = 0;
	const bool is_good = sscanf(miss.c_str(), "%5[a-z]:%d%n", side, &every, &end) == 2 && miss[end] == '\0';
	const bool is_left = is_good && strcmp(side, "left") == 0;
	if (!is_good || every < 2 || !(is_left || strcmp(side, "right") == 0))
		throw pong::UsageError("--miss " + miss + ": it takes left:N or right:N, N at least 2");
	settings.cameras[is_left ? 0 : 1].miss_every = every;
}

void inject_faults(const Request &request, const sim::Scene &scene, gige::ServerSettings &settings)
{
	const auto seed = static_cast<uint64_t>(request.seed);
	const sim::World world(scene, sim::make_rig(scene.rig), seed, request.rate, 1);
	const auto faults = sim::parse_faults(request.faults, world);
	for (size_t camera = 0; camera < faults.size(); camera++)
		settings.cameras[camera].faults = faults[camera];
	settings.seed = seed;
}

void say_counts(const gige::Server &server)
{
	const char *const names[] = {"left", "right"};
	for (int camera = 0; camera < 2; camera++) {
		const gige::CameraCounts counts = server.counts(camera);
		pong::say(pong::format("%s camera: %lld pictures sent, %lld triggers missed as told", names[camera],
				       static_cast<long long>(counts.pictures), static_cast<long long>(counts.missed)));
	}
}

void serve_cameras(const Request &request, const sim::Scene &scene, int64_t frames)
{
	sim::LiveWorld world(scene, static_cast<uint64_t>(request.seed), request.rate, request.truth);
	gige::ServerSettings settings;
	settings.cameras = {{"127.0.0.1", "SIML"}, {"127.0.0.2", "SIMR"}};
	settings.width = scene.rig.width;
	settings.height = scene.rig.height;
	settings.rate = request.rate;
	settings.exposure = scene.picture.exposure;
	settings.trigger_socket = request.trigger_line;
	if (!request.miss.empty())
		inject(request.miss, settings);
	inject_faults(request, scene, settings);
	gige::Server server(settings, world);
	// From here on the cameras can be reached: whoever waits for the rig may come.
	if (!request.rig.empty())
		sim::write_text(request.rig, sim::rig_text(sim::make_rig(scene.rig), scene.hit_z));
	pong::say(pong::format("cameras on 127.0.0.1 (left) and 127.0.0.2 (right), %g pulses a second, scene %s",
			       request.rate, request.scene.c_str()));
	server.run(frames);
	if (!request.miss.empty() || !request.trigger_line.empty() || !request.faults.empty())
		say_counts(server);
}

int simulate(int argc, char **argv)
{
	Request request;
	pong::Options accepted = options(&request);
	if (!accepted.parse(argc, argv))
		return 0;
	if (request.list_scenes) {
		list_scenes();
		return 0;
	}
	check(request);
	const sim::Scene scene = sim::load_scene(request.scene);
	const int64_t frames = frames_of(request, scene);
	if (request.cameras) {
		serve_cameras(request, scene, frames);
		return 0;
	}
	const int64_t written =
		sim::write_folder({request.folder, request.rate, frames}, scene, static_cast<uint64_t>(request.seed));
	pong::say(pong::format("%lld frames of scene %s written to %s", static_cast<long long>(written),
			       request.scene.c_str(), request.folder.c_str()));
	return 0;
}

} // namespace

int main(int argc, char **argv)
{
	return pong::run_program("pongeye-simulate", argc, argv, simulate);
}
