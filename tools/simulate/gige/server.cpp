// One thread serves all control ports and watches the trigger line; each camera exposes in a thread of its own. They
// agree on when a pulse comes because the line's times are known beforehand.
#include "server.hpp"

#include <poll.h>
#include <sys/prctl.h>

#include <algorithm>

#include "camera.hpp"
#include "clock.hpp"
#include "edge_socket.hpp"
#include "program.hpp"

namespace gige
{

namespace
{

constexpr Endpoint broadcast = {0xffffffff, gvcp::port};
constexpr int64_t longest_wait = 50000000; // heartbeats and requests to stop are looked at as often, ns
constexpr int edges_a_round = 16;          // fewer than the line remembers
constexpr int64_t lead = 20000000;         // from the last camera's start to the first pulse, ns
constexpr int64_t linger = 500000000;      // after the last pulse: its picture, and packets asked for again, ns

bool waits_for_line(const Acquisition &acquisition)
{
	return acquisition.session && acquisition.is_triggered && acquisition.by_line;
}

using Cameras = std::vector<std::unique_ptr<Camera>>;

Cameras open_cameras(const ServerSettings &settings, const TriggerLine &line, PictureSource &source)
{
	Cameras cameras;
	for (size_t i = 0; i < settings.cameras.size(); i++)
		cameras.push_back(std::make_unique<Camera>(settings, static_cast<int>(i), line, source));
	return cameras;
}

void require(bool is_good, const char *sentence)
{
	if (!is_good)
		throw pong::Failure(sentence);
}

const ServerSettings &check(const ServerSettings &settings)
{
	const auto is_side = [](int pixels) { return pixels >= 16 && pixels <= 8192 && pixels % 4 == 0; };
	require(!settings.cameras.empty(), "a camera server needs at least one camera");
	require(is_side(settings.width) && is_side(settings.height),
		"a simulated sensor's sides must be multiples of 4 between 16 and 8192 pixels");
	require(settings.rate > 0 && settings.rate <= 10000, "the trigger rate must lie between 0 and 10000 Hz");
	require(settings.exposure >= 10e-6 && settings.exposure <= 1, "the exposure must lie between 10 us and 1 s");
	require(settings.link_rate >= 1e6, "the link must carry 1 Mbit/s at least");
	return settings;
}

} // namespace

struct Server::Implementation {
	Implementation(const ServerSettings &wanted, PictureSource &picture_source);

	void run(int64_t pulses);
	void serve_until(int64_t time);
	void answer_discovery();
	void watch_line();
	void receive_edges();
	void switch_line();
	void report(const Pulse &pulse);
	void keep_power();
	void notify();
	bool any_waits() const;
	bool all_wait() const;

	const ServerSettings settings;
	PictureSource &source;
	double exposure = settings.exposure; // as the cameras have it, s
	TriggerLine line;
	Cameras cameras;
	const UdpSocket discovery_socket;
	std::unique_ptr<EdgeSocket> edge_socket; // none: the line makes its own pulses
	std::vector<pollfd> inputs;
};

Server::Implementation::Implementation(const ServerSettings &wanted, PictureSource &picture_source)
	: settings(check(wanted)), source(picture_source), line(wanted.rate, monotonic_now()),
	  cameras(open_cameras(settings, line, source)), discovery_socket(broadcast)
{
	for (const auto &camera : cameras)
		inputs.push_back({camera->control_descriptor(), POLLIN, 0});
	inputs.push_back({discovery_socket.descriptor(), POLLIN, 0});
	if (settings.trigger_socket.empty())
		return;
	edge_socket = std::make_unique<EdgeSocket>(settings.trigger_socket);
	inputs.push_back({edge_socket->descriptor(), POLLIN, 0});
	line.connect_outside();
}

void Server::Implementation::run(int64_t pulses)
{
	prctl(PR_SET_TIMERSLACK, 1000); // ns
	line.end_at(pulses);
	keep_power();
	while (!pong::stop_requested() && !line.has_ended()) {
		const int64_t patience = monotonic_now() + longest_wait;
		serve_until(std::min(patience, line.next_time().value_or(patience)));
		watch_line();
		keep_power();
	}
	const int64_t end = monotonic_now() + linger;
	while (!pong::stop_requested() && monotonic_now() < end)
		serve_until(end);
	for (const auto &camera : cameras)
		camera->power_down();
}

// Serve one round of datagrams, or sleep until `time` where none comes.
void Server::Implementation::serve_until(int64_t time)
{
	const int64_t wait = std::clamp<int64_t>(time - monotonic_now(), 0, longest_wait);
	const timespec timeout = {0, wait};
	if (ppoll(inputs.data(), inputs.size(), &timeout, nullptr) > 0) {
		for (const auto &camera : cameras)
			camera->serve();
		answer_discovery();
		receive_edges();
	}
	for (const auto &camera : cameras)
		if (camera->is_on())
			camera->control().check_heartbeat(monotonic_now());
}

void Server::Implementation::keep_power()
{
	for (const auto &camera : cameras) {
		camera->keep_power();
		camera->keep_clock();
	}
}

// For cameras that wait for the line.
void Server::Implementation::notify()
{
	for (const auto &camera : cameras)
		if (camera->is_on())
			camera->control().notify();
}

void Server::Implementation::answer_discovery()
{
	Bytes datagram;
	Endpoint from;
	for (int i = 0; i < datagrams_a_round && discovery_socket.receive(datagram, from); i++)
		for (const auto &camera : cameras)
			camera->answer_discovery(datagram, from);
}

void Server::Implementation::receive_edges()
{
	for (int i = 0; edge_socket && i < edges_a_round; i++) {
		const std::optional<int64_t> time = edge_socket->receive();
		if (!time)
			return;
		line.add_edge(*time);
		notify();
	}
}

void Server::Implementation::watch_line()
{
	while (const std::optional<Pulse> pulse = line.take(monotonic_now()))
		report(*pulse);
	if (!edge_socket)
		switch_line();
}

// Its own pulses come from when every camera that has a client waits for them, until none does.
void Server::Implementation::switch_line()
{
	if (line.is_running() && !any_waits()) {
		line.stop();
	} else if (!line.is_running() && all_wait()) {
		line.start(monotonic_now() + lead);
		notify();
	}
}

// The middle is that of the first camera's exposure, should a client have set them differently.
void Server::Implementation::report(const Pulse &pulse)
{
	for (const auto &camera : cameras)
		if (camera->is_on()) {
			exposure = camera->control().acquisition().exposure;
			break;
		}
	source.exposed(pulse.number, monotonic_to_realtime(pulse.time + nanoseconds(exposure / 2)) / 1000);
}

bool Server::Implementation::any_waits() const
{
	return std::any_of(cameras.begin(), cameras.end(), [](const auto &camera) {
		return camera->is_on() && waits_for_line(camera->control().acquisition());
	});
}

bool Server::Implementation::all_wait() const
{
	return any_waits() && std::all_of(cameras.begin(), cameras.end(), [](const auto &camera) {
		       return !camera->is_on() || !camera->control().is_controlled() ||
			      waits_for_line(camera->control().acquisition());
	       });
}

Server::Server(const ServerSettings &settings, PictureSource &source)
	: implementation_(std::make_unique<Implementation>(settings, source))
{
}

Server::~Server() = default;

void Server::run(int64_t pulses)
{
	implementation_->run(pulses);
}

CameraCounts Server::counts(int camera) const
{
	return implementation_->cameras[static_cast<size_t>(camera)]->counts();
}

} // namespace gige
