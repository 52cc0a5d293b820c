#include "camera.hpp"

#include <sys/prctl.h>

#include <algorithm>
#include <cmath>

#include "clock.hpp"

namespace gige
{

namespace
{

constexpr int64_t readout = 300000;      // from the exposure's end to the first packet, ns
constexpr int64_t idle_wait = 100000000; // how often a still camera looks around, ns
constexpr int64_t patience = 4000000;    // a picture later than this is stale, ns
constexpr int64_t forgotten = 30000000;  // an edge from outside that is found so late is missed, ns
constexpr size_t ethernet_overhead = 38; // preamble, header, check sum, gap: bytes that a packet costs the link
constexpr double longest_death = 1e6;    // s
constexpr int64_t burst = 200000;        // packets leave up to this early: fewer wake-ups than one a packet, ns

// Every camera has its own clock; that of camera 0 began 1 s before power-on, that of camera 1 2 s before, and so on.
int64_t clock_begin(int index)
{
	return monotonic_now() - (index + 1) * nanoseconds(1);
}

double drift_of(const CameraSettings &camera)
{
	for (const Fault &fault : camera.faults)
		if (fault.kind == FaultKind::drift)
			return fault.amount;
	return 0;
}

ControlSettings control_settings(const ServerSettings &settings, int index)
{
	const CameraSettings &camera = settings.cameras[static_cast<size_t>(index)];
	return {parse_address(camera.address.c_str()),
		camera.serial,
		settings.width,
		settings.height,
		settings.exposure,
		clock_begin(index),
		drift_of(camera)};
}

// Gain is an amplifier's: a factor of 10^(gain / 20), gain in dB.
void brighten(Bytes &pixels, double gain)
{
	const double factor = std::pow(10.0, gain / 20);
	uint8_t brighter[256];
	for (int value = 0; value < 256; value++)
		brighter[value] = static_cast<uint8_t>(std::min(255.0, std::round(value * factor)));
	for (uint8_t &pixel : pixels)
		pixel = brighter[pixel];
}

uint32_t address_of(const ServerSettings &settings, int index)
{
	return parse_address(settings.cameras[static_cast<size_t>(index)].address.c_str());
}

} // namespace

Camera::Camera(const ServerSettings &settings, int index, const TriggerLine &line, PictureSource &source)
	: index_(index), width_(settings.width), height_(settings.height), link_rate_(settings.link_rate),
	  miss_every_(settings.cameras[static_cast<size_t>(index)].miss_every),
	  is_outside_(!settings.trigger_socket.empty()), control_settings_(control_settings(settings, index)),
	  line_(line), source_(source), control_socket_({address_of(settings, index), gvcp::port}),
	  stream_socket_({address_of(settings, index), 0}),
	  faults_(settings.cameras[static_cast<size_t>(index)].faults, settings.rate,
		  settings.seed * 2 + static_cast<uint64_t>(index)),
	  wire_(stream_socket_, faults_), pixels_(static_cast<size_t>(width_) * static_cast<size_t>(height_))
{
}

Camera::~Camera()
{
	power_down();
}

void Camera::keep_power()
{
	const int64_t now = monotonic_now();
	const Fault *death = faults_.find(FaultKind::die, line_.count() + 1);
	if (death && !dead_until_) {
		const double seconds = std::min(death->end - death->begin, longest_death);
		dead_until_ = now + nanoseconds(seconds);
		power_down();
	}
	if (!is_on_ && (!dead_until_ || now >= *dead_until_))
		power_up();
	if (!death && is_on_)
		dead_until_.reset();
}

void Camera::power_up()
{
	const bool is_reborn = dead_until_.has_value();
	if (is_reborn)
		control_settings_.power_on = monotonic_now();
	control_ = std::make_unique<Control>(control_settings_, ring_);
	control_->set_stream_source_port(stream_socket_.port());
	if (!is_reborn && faults_.find(FaultKind::held, 0))
		control_->leave_held(monotonic_now());
	session_ = 0;
	sensor_free_ = 0;
	is_on_ = true;
	thread_ = std::thread([this] { expose_pictures(); });
}

void Camera::power_down()
{
	if (!is_on_)
		return;
	is_on_ = false;
	control_->finish(control_->acquisition().session);
	thread_.join();
}

void Camera::keep_clock()
{
	if (is_on_)
		control_->set_clock_step(nanoseconds(faults_.amount(FaultKind::offset, line_.count() + 1)));
}

// What comes while it has no power nobody hears.
void Camera::serve()
{
	Bytes datagram;
	Endpoint from;
	for (int i = 0; i < datagrams_a_round && control_socket_.receive(datagram, from); i++) {
		if (!is_on_)
			continue;
		const Answer answer = control_->handle(datagram.data(), datagram.size(), from, monotonic_now());
		if (!answer.reply.empty())
			control_socket_.send(from, answer.reply);
		for (const Bytes &packet : answer.stream)
			wire_.send(answer.destination, packet, line_.count());
	}
}

void Camera::answer_discovery(const Bytes &datagram, const Endpoint &from)
{
	if (!is_on_)
		return;
	const Bytes reply = control_->discover(datagram.data(), datagram.size());
	if (!reply.empty())
		control_socket_.send(from, reply);
}

void Camera::expose_pictures()
{
	prctl(PR_SET_TIMERSLACK, 1000); // ns: waits end when they should, not 50 us later
	while (is_on_) {
		const Acquisition acquisition = control_->acquisition();
		if (acquisition.session && acquisition.session != session_)
			begin_session(acquisition);
		const std::optional<Shot> shot = acquisition.session ? plan(acquisition) : std::nullopt;
		if (shot && is_to_miss(*shot))
			miss(*shot, acquisition);
		else if (shot)
			take(*shot, acquisition);
		else
			control_->wait_for_change(monotonic_now() + idle_wait, acquisition);
	}
}

void Camera::begin_session(const Acquisition &acquisition)
{
	session_ = acquisition.session;
	session_begin_ = monotonic_now();
	software_triggers_ = 0;
	frame_id_ = static_cast<uint16_t>(faults_.amount(FaultKind::block, 0, 1) - 1);
	ring_.clear();
}

// The next exposure that can still be had: the sensor must be free, and there must be time to render the picture until
// it is due.
std::optional<Camera::Shot> Camera::plan(const Acquisition &acquisition)
{
	const int64_t rendered = monotonic_now() + render_time_;
	const int64_t earliest = std::max(sensor_free_, rendered - nanoseconds(acquisition.exposure) - readout);
	if (!acquisition.is_triggered)
		return plan_free(acquisition, earliest);
	if (!acquisition.by_line)
		return plan_by_software(acquisition);
	return plan_by_line(is_outside_ ? std::max(sensor_free_, monotonic_now() - forgotten) : earliest);
}

std::optional<Camera::Shot> Camera::plan_by_line(int64_t earliest) const
{
	const std::optional<Pulse> pulse = line_.next(earliest);
	if (!pulse)
		return std::nullopt;
	return Shot{pulse->time, pulse->number, true, is_outside_};
}

// Several triggers that come while a picture is under way make one more picture.
std::optional<Camera::Shot> Camera::plan_by_software(const Acquisition &acquisition)
{
	if (software_triggers_ == acquisition.software_triggers)
		return std::nullopt;
	software_triggers_ = acquisition.software_triggers;
	const int64_t start = std::max(sensor_free_, monotonic_now());
	return Shot{start, line_.number_at(start), false, true};
}

Camera::Shot Camera::plan_free(const Acquisition &acquisition, int64_t earliest) const
{
	const Schedule schedule{session_begin_, acquisition.frame_rate};
	const int64_t start = schedule.time(schedule.first_from(earliest));
	return {start, line_.number_at(start), false, false};
}

bool Camera::is_to_miss(const Shot &shot)
{
	const bool in_turn = miss_every_ > 0 && shot.pulse % miss_every_ == 0;
	return shot.is_by_line && (in_turn || faults_.strikes(FaultKind::miss, shot.pulse));
}

// As if the edge had not been seen.
void Camera::miss(const Shot &shot, const Acquisition &acquisition)
{
	sensor_free_ = shot.start + 1;
	if (control_->wait_in_session(shot.start, acquisition.session))
		missed_++;
}

// Rendered before it is due, sent when it is: or not at all, where the machine was too busy to render it in time.
void Camera::take(const Shot &shot, const Acquisition &acquisition)
{
	const int64_t end = shot.start + nanoseconds(acquisition.exposure);
	sensor_free_ = std::max(end, shot.start + 1);
	if (!faults_.find(FaultKind::freeze, shot.pulse))
		render(shot, acquisition);
	if (!control_->wait_in_session(end + readout, acquisition.session))
		return;
	if (!shot.can_wait && monotonic_now() > end + readout + patience)
		return;
	stream(compose(shot, acquisition), acquisition);
	pictures_++;
	if (acquisition.is_single_frame)
		control_->finish(acquisition.session);
}

void Camera::render(const Shot &shot, const Acquisition &acquisition)
{
	const int64_t begin = monotonic_now();
	source_.render(index_, shot.pulse, acquisition.exposure, pixels_.data());
	render_time_ += (monotonic_now() - begin - render_time_) / 8; // a running mean
}

const Frame &Camera::compose(const Shot &shot, const Acquisition &acquisition)
{
	if (++frame_id_ == 0)
		frame_id_ = 1; // 0 is no frame id
	frame_.id = frame_id_;
	frame_.timestamp = control_->device_time(shot.start);
	frame_.region = acquisition.region;
	frame_.has_chunks = acquisition.has_chunks;
	frame_.packet_size = acquisition.packet_size;
	crop(acquisition.region);
	if (acquisition.gain > 0)
		brighten(frame_.data, acquisition.gain);
	if (frame_.has_chunks) {
		const int64_t count = (shot.is_by_line ? shot.pulse : line_.count()) +
				      (faults_.find(FaultKind::miscount, shot.pulse) ? 1 : 0);
		append_chunks(frame_, {static_cast<float>(acquisition.exposure * 1e6), shot.is_by_line ? 1u : 0u,
				       static_cast<uint32_t>(count)});
	}
	if (faults_.strikes(FaultKind::truncate, shot.pulse))
		frame_.data.resize(frame_.data.size() / 2);
	return ring_.add(frame_);
}

// The region of interest.
void Camera::crop(const Region &region)
{
	frame_.data.resize(static_cast<size_t>(region.width) * region.height);
	for (uint32_t row = 0; row < region.height; row++) {
		const uint8_t *from = &pixels_[(row + region.y) * static_cast<size_t>(width_) + region.x];
		std::copy(from, from + region.width, &frame_.data[static_cast<size_t>(row) * region.width]);
	}
}

// The last packet leaves when the link could have carried them all, none much before its turn.
void Camera::stream(const Frame &frame, const Acquisition &acquisition)
{
	if (acquisition.destination.port == 0)
		return;
	const size_t count = packet_count(frame);
	int64_t due = monotonic_now();
	for (size_t i = 0; i < count; i++) {
		make_packet(frame, i, Status::success, datagram_);
		const size_t bytes = datagram_.size() + gvsp::ip_udp_size + ethernet_overhead;
		due += nanoseconds(static_cast<double>(bytes) * 8 / link_rate_) + acquisition.packet_delay;
		if (i + 1 == count || due > monotonic_now() + burst)
			sleep_until(due);
		wire_.send(acquisition.destination, datagram_, line_.count());
	}
}

} // namespace gige
