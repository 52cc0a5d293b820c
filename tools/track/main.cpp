// pongeye-track: watch two cameras, a folder of pictures, or a recording, and say where the ball is and where it can be
// hit.
//
// track_ball() is the loop; all else opens what it reads from and writes to.
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "arguments.hpp"
#include "cameras.hpp"
#include "clock.hpp"
#include "eager_eye.hpp"
#include "fast_path.hpp"
#include "images.hpp"
#include "live_table.hpp"
#include "output.hpp"
#include "owned.hpp"
#include "program.hpp"
#include "publisher.hpp"
#include "recording.hpp"
#include "replay.hpp"
#include "setup.hpp"
#include "status.hpp"
#include "trigger_listener.hpp"

namespace track
{

namespace
{

// Where the results go; whatever is not wanted is null.
struct Sinks {
	std::unique_ptr<Recording> recording; // outlives the publisher, which records too
	std::unique_ptr<Publisher> publisher;
	std::unique_ptr<Output> output;
	std::unique_ptr<Live> live;
};

struct Session {
	Sinks sinks;
	Status status;
	int64_t end_ns; // by monotonic_ns()
};

pong::OwnedEye open_eye(const Setup &setup)
{
	pong_error error;
	pong::OwnedEye eye(pong_eye_new(&setup.rig, &setup.settings, &error));
	if (!eye)
		throw pong::Failure(error.text);
	return eye;
}

// The trigger is listened to on the bus that is published on.
std::unique_ptr<TriggerListener> open_listener(const Arguments &arguments, const Sinks &sinks)
{
	if (!arguments.from_cameras() || !sinks.publisher || !TriggerListener::can_hear(sinks.publisher->url()))
		return nullptr;
	return std::make_unique<TriggerListener>(sinks.publisher->url());
}

std::unique_ptr<Replay> open_replay(const Arguments &arguments)
{
	return arguments.replay.empty() ? nullptr : std::make_unique<Replay>(arguments.replay);
}

// A recording has the rig and the profile that it was made with, where the user names no others.
Setup open_setup(const Arguments &arguments, const Replay *replay)
{
	const RigText text = arguments.rig.empty() ? replay->rig() : read_rig_text(arguments.rig);
	const bool recorded = replay && !arguments.profile_given;
	return make_setup(text, recorded ? replay->profile() : static_cast<pong_profile>(arguments.profile));
}

std::unique_ptr<Source> open_live(const Setup &setup, const CaptureSettings &settings, TriggerListener *listener,
				  Onlooker &onlooker)
{
	HearPulse hear;
	if (listener && !settings.trigger.empty())
		hear = [listener](TriggerPulse &pulse) { return listener->take(pulse); };
	return open_cameras(setup.rig, settings, std::move(hear), &onlooker);
}

Sinks open_sinks(const Arguments &arguments, const Setup &setup)
{
	Sinks sinks;
	const bool recorded = !arguments.record.empty();
	if (arguments.publish || recorded) // what nobody is to hear is recorded all the same
		sinks.publisher = std::make_unique<Publisher>(arguments.publish ? arguments.lcm_url : "memq://");
	if (recorded)
		sinks.recording = std::make_unique<Recording>(arguments, setup, *sinks.publisher);
	if (!arguments.output.empty())
		sinks.output = std::make_unique<Output>(arguments.output);
	if (arguments.live)
		sinks.live = std::make_unique<Live>();
	return sinks;
}

int64_t end_after(double seconds)
{
	return seconds > 0 ? monotonic_ns() + std::llround(seconds * 1e9) : INT64_MAX;
}

// All that has time. What is to be published is so already.
void deliver(const Seen &seen, Session &session)
{
	const Sinks &sinks = session.sinks;
	session.status.count(seen.sight, static_cast<double>(seen.published_ns - seen.pair.arrival_ns) * 1e-9);
	if (sinks.output)
		sinks.output->write(seen.pair, seen.sight);
	if (sinks.live)
		sinks.live->see(seen.sight);
	if (sinks.recording)
		sinks.recording->add(seen.pair, seen.sight);
}

// What time brings, whether pairs come or not.
void keep_time(const Source &source, Session &session)
{
	const Sinks &sinks = session.sinks;
	Status &status = session.status;
	const int64_t now_ns = monotonic_ns();
	const std::string warning = status.rig_watch().warning();
	if (!warning.empty())
		pong::say(warning);
	if (status.second_over(now_ns)) {
		status.close_second(now_ns, source);
		if (sinks.publisher)
			sinks.publisher->publish(status.report());
	}
	if (sinks.live)
		sinks.live->draw(status.report(), now_ns);
	if (sinks.recording)
		sinks.recording->listen();
	if (now_ns >= session.end_ns)
		pong::request_stop();
}

// While it lives, the cameras' threads may take the fast path.
class Shift
{
public:
	Shift(FastPath &fast_path, Source &source) : fast_path_(fast_path)
	{
		fast_path_.begin(source);
	}

	~Shift()
	{
		fast_path_.end();
	}

	Shift(const Shift &) = delete;
	Shift &operator=(const Shift &) = delete;

private:
	FastPath &fast_path_;
};

// The loop. What was published is delivered, too, before it ends.
void track_ball(Source &source, FastPath &fast_path, Session &session)
{
	const Shift shift(fast_path, source);
	for (;;) {
		const Seen &seen = fast_path.next();
		if (seen.next == Next::END)
			return;
		if (seen.next == Next::PAIR)
			deliver(seen, session);
		else if (seen.next == Next::ALONE && session.sinks.recording)
			session.sinks.recording->add_alone(seen.pair);
		keep_time(source, session);
		if (pong::stop_requested())
			return;
		if (seen.next == Next::NOTHING_YET)
			fast_path.wait();
	}
}

int run(int argc, char **argv)
{
	Arguments arguments;
	if (!parse_arguments(argc, argv, arguments))
		return 0;
	if (arguments.list) {
		list_cameras();
		return 0;
	}
	std::unique_ptr<Replay> replay = open_replay(arguments);
	const Setup setup = open_setup(arguments, replay.get());
	const CaptureSettings capture =
		arguments.rig.empty() ? CaptureSettings() : load_capture_settings(arguments.rig);
	const pong::OwnedEye eye = open_eye(setup);
	EagerEye eager(eye.get(), capture.rate);
	Sinks sinks = open_sinks(arguments, setup);
	FastPath fast_path(eager, sinks.publisher.get());
	const std::unique_ptr<TriggerListener> listener = open_listener(arguments, sinks);
	std::unique_ptr<Source> source = std::move(replay);
	if (!arguments.images.empty())
		source = open_images(arguments.images, arguments.fps, capture.exposure);
	else if (!source)
		source = open_live(setup, capture, listener.get(), fast_path);
	Session session = {std::move(sinks), Status(monotonic_ns()), end_after(arguments.seconds)};
	track_ball(*source, fast_path, session);
	session.sinks.live.reset();
	pong::say(session.status.summary(*source));
	return session.sinks.recording && !session.sinks.recording->finish();
}

} // namespace

} // namespace track

int main(int argc, char **argv)
{
	return pong::run_program("pongeye-track", argc, argv, track::run);
}
