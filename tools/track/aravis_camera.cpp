#include "aravis_camera.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "description_mutex.hpp"
#include "presence.hpp"
#include "realtime.hpp"

namespace track
{

namespace
{

constexpr int BUFFERS = 64; // of a stream: more than are ever waiting to be tracked, so that it never runs dry
constexpr int STREAM_PRIORITY = 10;
constexpr std::chrono::seconds CLOCK_INTERVAL(1); // between comparisons of the clocks
constexpr int CLOCK_TRIES = 8;                    // the fastest is taken,
constexpr int CLOCK_TRIES_IN_HASTE = 2;           // while a picture waits for it
constexpr int64_t SETTLED_NS = 100000000;         // so old is no picture that comes
constexpr int64_t GOOD_CLOCK_NS = 500000;         // error of the first one; pictures of two pulses lie far wider apart

// Aravis' way to report a failure, turned into ours.
class Fault
{
public:
	~Fault()
	{
		g_clear_error(&error_);
	}

	operator GError **()
	{
		g_clear_error(&error_);
		return &error_;
	}

	bool failed() const
	{
		return error_ != nullptr;
	}

	const char *text() const
	{
		return error_ ? error_->message : "no reason given";
	}

	// Throws where the last call failed: Absent where the camera did not answer or is not ours any more.
	void check(const std::string &camera, const char *what) const
	{
		if (!error_)
			return;
		const std::string sentence = camera + ": " + what + ": " + text();
		if (error_->domain == ARV_DEVICE_ERROR && is_of_transport(error_->code))
			throw Absent(sentence);
		throw pong::Failure(sentence);
	}

private:
	static bool is_of_transport(int code)
	{
		return code == ARV_DEVICE_ERROR_TIMEOUT || code == ARV_DEVICE_ERROR_NOT_CONNECTED ||
		       code == ARV_DEVICE_ERROR_TRANSFER_ERROR || code == ARV_DEVICE_ERROR_PROTOCOL_ERROR ||
		       code == ARV_DEVICE_ERROR_NOT_CONTROLLER;
	}

	GError *error_ = nullptr;
};

void on_control_lost(ArvDevice *, std::atomic<bool> *lost)
{
	*lost = true;
}

} // namespace

Camera::Camera(pong_side side, const pong_camera &camera, const CaptureSettings &settings, int number,
	       CaptureCounts &counts, Receive receive)
	: side_(side), name_(camera_name(side, camera)), number_(number), width_(camera.width), height_(camera.height),
	  receive_(std::move(receive)), still_(camera.width, camera.height), counts_(counts)
{
	open(camera.id);
	set_picture(camera, settings);
	set_exposure(settings);
	set_trigger(settings);
	if (settings.counter && !settings.trigger.empty())
		counter_.open(camera_.get(), settings.trigger, settings.falling_edge);
	set_packets(settings);
	set_ptp(settings);
	find_clock();
	open_stream();
	start();
	clock_reader_ = std::make_unique<Ticker>(CLOCK_INTERVAL, [this] { read_clock(CLOCK_TRIES); });
}

Camera::~Camera()
{
	clock_reader_.reset();
	g_signal_handlers_disconnect_by_data(arv_camera_get_device(camera_.get()), &lost_);
	const std::lock_guard<std::mutex> lock(features_mutex_);
	if (!lost_)
		arv_camera_stop_acquisition(camera_.get(), nullptr);
}

void Camera::open(const char *id)
{
	Fault fault;
	{
		const std::lock_guard<std::mutex> lock(description_mutex());
		camera_.reset(arv_camera_new(id, fault));
	}
	if (!camera_)
		throw Absent(
			name_ + ": not found: no GigE Vision camera on any network interface and no USB3 Vision " +
			"camera has this address, serial number or id (pongeye-track --list shows those that answer)");
	ArvDevice *device = arv_camera_get_device(camera_.get());
	// Aravis opens a camera that another program controls, too, and then every setting fails.
	if (ARV_IS_GV_DEVICE(device) && !arv_gv_device_is_controller(ARV_GV_DEVICE(device)))
		throw Absent(name_ + ": another program controls it");
	g_signal_connect(device, "control-lost", G_CALLBACK(on_control_lost), &lost_);
}

// The calibration holds for the picture that it was made with: any other size is an error.
void Camera::set_picture(const pong_camera &camera, const CaptureSettings &settings)
{
	Fault fault;
	arv_camera_set_pixel_format(camera_.get(), ARV_PIXEL_FORMAT_MONO_8, fault);
	fault.check(name_, "cannot send grey pictures of 8 bits (Mono8)");
	arv_camera_set_region(camera_.get(), settings.offset_x, settings.offset_y, camera.width, camera.height, fault);
	const std::string size =
		pong::format("cannot send %d x %d pixels, the size in rig.toml", camera.width, camera.height);
	fault.check(name_, size.c_str());
	int x, y, width, height;
	arv_camera_get_region(camera_.get(), &x, &y, &width, &height, fault);
	fault.check(name_, "does not tell its picture size");
	if (width != camera.width || height != camera.height)
		throw pong::Failure(name_ + ": " + size + pong::format(", but %d x %d", width, height));
}

// Aravis would set the nearest that the camera can, without a word.
void Camera::check_limits(const Wish &wish) const
{
	if (wish.value < wish.least || wish.value > wish.most)
		throw pong::Failure(pong::format("%s: %s: rig.toml asks for %g %s, and it can %g to %g", name_.c_str(),
						 wish.what, wish.value, wish.unit, wish.least, wish.most));
}

// A camera that still exposes misses the next pulse.
void Camera::check_rate(double exposure, double rate) const
{
	if (exposure * rate >= 1)
		throw pong::Failure(pong::format("%s: it exposes for %g ms, but at %g Hz a picture has %.3g ms: set a "
						 "shorter exposure in [capture] of rig.toml",
						 name_.c_str(), exposure * 1e3, rate, 1e3 / rate));
}

// Automatic exposure and gain are switched off where there are any: the ball's brightness must not depend on the rest.
void Camera::set_exposure(const CaptureSettings &settings)
{
	Fault fault;
	ArvCamera *camera = camera_.get();
	if (arv_camera_is_exposure_auto_available(camera, nullptr))
		arv_camera_set_exposure_time_auto(camera, ARV_AUTO_OFF, nullptr);
	if (settings.exposure > 0) {
		double least, most;
		arv_camera_get_exposure_time_bounds(camera, &least, &most, fault);
		fault.check(name_, "does not tell which exposures it can");
		check_limits({"exposure", settings.exposure, least * 1e-6, most * 1e-6, "s"});
		check_rate(settings.exposure, settings.rate);
		arv_camera_set_exposure_time(camera, settings.exposure * 1e6, fault);
		fault.check(name_, "cannot set the exposure");
	}
	exposure_ns_ = std::llround(arv_camera_get_exposure_time(camera, fault) * 1e3);
	fault.check(name_, "does not tell its exposure");
	check_rate(static_cast<double>(exposure_ns_) * 1e-9, settings.rate);
	if (!settings.has_gain)
		return;
	if (arv_camera_is_gain_auto_available(camera, nullptr))
		arv_camera_set_gain_auto(camera, ARV_AUTO_OFF, nullptr);
	double least, most;
	arv_camera_get_gain_bounds(camera, &least, &most, fault);
	fault.check(name_, "does not tell which gains it can");
	check_limits({"gain", settings.gain, least, most, "dB"});
	arv_camera_set_gain(camera, settings.gain, fault);
	fault.check(name_, "cannot set the gain");
}

// The frame rate first: setting it clears the trigger. With a trigger the rate is the trigger's alone.
void Camera::set_trigger(const CaptureSettings &settings)
{
	Fault fault;
	arv_camera_set_acquisition_mode(camera_.get(), ARV_ACQUISITION_MODE_CONTINUOUS, fault);
	fault.check(name_, "cannot send pictures continuously");
	if (settings.trigger.empty()) {
		arv_camera_clear_triggers(camera_.get(), fault);
		fault.check(name_, "cannot run without a trigger");
		if (settings.rate > 0)
			arv_camera_set_frame_rate(camera_.get(), settings.rate, fault);
		fault.check(name_, "cannot set the frame rate");
		return;
	}
	arv_camera_set_trigger(camera_.get(), settings.trigger.c_str(), fault);
	fault.check(name_, ("cannot be triggered by " + settings.trigger).c_str());
	if (settings.falling_edge)
		arv_camera_set_string(camera_.get(), "TriggerActivation", "FallingEdge", fault);
	fault.check(name_, "cannot be triggered by a falling edge");
}

// Large packets cost the host less; the ring of a packet socket would cost 2.4 ms of latency.
void Camera::set_packets(const CaptureSettings &settings)
{
	if (!arv_camera_is_gv_device(camera_.get()))
		return;
	Fault fault;
	arv_camera_gv_set_stream_options(camera_.get(), ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
	arv_camera_gv_set_packet_size_adjustment(camera_.get(), ARV_GV_PACKET_SIZE_ADJUSTMENT_NEVER);
	if (settings.packet_size > 0)
		arv_camera_gv_set_packet_size(camera_.get(), settings.packet_size, fault);
	else
		arv_camera_gv_auto_packet_size(camera_.get(), fault);
	fault.check(name_, "cannot set the packet size");
	if (settings.packet_delay >= 0)
		arv_camera_gv_set_packet_delay(camera_.get(), std::llround(settings.packet_delay * 1e9), fault);
	fault.check(name_, "cannot set the delay between packets");
}

// A clock that follows another one over the network is compared like any other: PTP may lose its master, or find
// another.
void Camera::set_ptp(const CaptureSettings &settings)
{
	for (const char *const feature : {"PtpEnable", "GevIEEE1588"}) {
		if (!arv_camera_is_feature_available(camera_.get(), feature, nullptr))
			continue;
		Fault fault;
		if (settings.ptp != (arv_camera_get_boolean(camera_.get(), feature, nullptr) != FALSE))
			arv_camera_set_boolean(camera_.get(), feature, settings.ptp, fault);
		if (fault.failed())
			pong::say(name_ + ": cannot switch its clock's PTP: " + fault.text());
		return;
	}
}

void Camera::find_clock()
{
	has_clock_ = arv_camera_is_feature_available(camera_.get(), "TimestampLatch", nullptr) &&
		     arv_camera_is_feature_available(camera_.get(), "TimestampLatchValue", nullptr);
	for (int i = 0; has_clock_ && i < 10 && clock_error_ns_ > GOOD_CLOCK_NS; i++)
		read_clock(CLOCK_TRIES);
	if (has_clock_ && !clock_.known())
		throw Absent(name_ + ": does not answer when asked for the time");
	if (!has_clock_)
		pong::say(name_ + ": it has no TimestampLatch: times are those of the pictures' arrival, "
				  "less the exposure");
}

// One thread's latch is not another one's value. None where the camera does not answer.
std::optional<ClockReading> Camera::latch_clock()
{
	const std::lock_guard<std::mutex> lock(features_mutex_);
	Fault fault;
	ClockReading reading;
	reading.before_ns = unix_ns();
	arv_camera_execute_command(camera_.get(), "TimestampLatch", fault);
	reading.after_ns = unix_ns();
	if (!fault.failed())
		reading.device_ns = arv_camera_get_integer(camera_.get(), "TimestampLatchValue", fault);
	return fault.failed() ? std::nullopt : std::optional<ClockReading>(reading);
}

// The fastest of several round trips says most about when the latch happened.
void Camera::read_clock(int tries)
{
	if (!has_clock_)
		return;
	ClockReading best = {};
	for (int i = 0; i < tries; i++) {
		const std::optional<ClockReading> reading = latch_clock();
		if (!reading)
			return;
		if (i == 0 || reading->round_trip_ns() < best.round_trip_ns())
			best = *reading;
	}
	const std::lock_guard<std::mutex> lock(clock_mutex_);
	if (!clock_.add(best)) {
		clock_set_ns_ = monotonic_ns();
		pong::say(name_ + ": its clock was set, or this computer's: they are compared anew");
	}
	clock_error_ns_ = std::min(clock_error_ns_, best.round_trip_ns() / 2);
}

// Tuned for the least latency that loses no packet: a missing one is asked for again after 1 ms, at once where later
// ones have come, and a picture that is not complete within 8 ms is given up.
void Camera::open_stream()
{
	Fault fault;
	stream_.reset(arv_camera_create_stream(camera_.get(), on_stream, this, fault));
	if (!stream_)
		throw pong::Failure(name_ + ": cannot open the picture stream: " + fault.text());
	if (ARV_IS_GV_STREAM(stream_.get()))
		g_object_set(stream_.get(), "socket-buffer", ARV_GV_STREAM_SOCKET_BUFFER_FIXED, "socket-buffer-size",
			     4 << 20, "packet-timeout", 1000u, "initial-packet-timeout", 0u, "frame-retention", 8000u,
			     "packet-request-ratio", 1.0, nullptr);
	const guint payload = arv_camera_get_payload(camera_.get(), fault);
	fault.check(name_, "does not tell the size of its pictures");
	for (int i = 0; i < BUFFERS; i++)
		arv_stream_push_buffer(stream_.get(),
				       arv_buffer_new_full(payload, nullptr, GINT_TO_POINTER(number_), nullptr));
}

void Camera::start()
{
	const std::lock_guard<std::mutex> lock(features_mutex_); // pictures come before this returns
	Fault fault;
	last_sign_ns_ = monotonic_ns();
	arv_camera_start_acquisition(camera_.get(), fault);
	fault.check(name_, "cannot start");
}

void Camera::give_back(void *buffer)
{
	arv_stream_push_buffer(stream_.get(), static_cast<ArvBuffer *>(buffer));
}

// In the stream's own thread.
void Camera::on_stream(void *camera, ArvStreamCallbackType event, ArvBuffer *)
{
	if (event == ARV_STREAM_CALLBACK_TYPE_INIT)
		make_thread_realtime(STREAM_PRIORITY);
	else if (event == ARV_STREAM_CALLBACK_TYPE_BUFFER_DONE)
		static_cast<Camera *>(camera)->receive_buffer();
}

void Camera::receive_buffer()
{
	ArvBuffer *buffer = arv_stream_pop_buffer(stream_.get());
	if (!buffer)
		return;
	const int64_t arrival_ns = monotonic_ns();
	last_sign_ns_ = arrival_ns;
	if (!is_whole(buffer)) {
		counts_.incomplete++;
		give_back(buffer);
		return;
	}
	if (still_.is_repeated(image_of(buffer))) {
		repeats_++;
		counts_.repeated++;
		give_back(buffer);
		return;
	}
	repeats_ = 0;
	g_object_ref(buffer); // whoever takes it may let go of it before it is remembered
	const Object<ArvBuffer> held(buffer);
	hand_on(buffer, arrival_ns);
	still_.remember(image_of(buffer));
}

void Camera::hand_on(ArvBuffer *buffer, int64_t arrival_ns)
{
	const std::optional<int64_t> begin_ns = exposure_begin_ns(buffer);
	if (!begin_ns) {
		counts_.undated++;
		give_back(buffer);
	} else if (!receive_(side_,
			     {(*begin_ns + exposure_ns_ / 2) / 1000, arrival_ns, buffer, counter_.read(buffer)})) {
		counts_.late++;
		give_back(buffer);
	}
}

// All packets came, and they are a picture of the size that was asked for.
bool Camera::is_whole(void *buffer) const
{
	ArvBuffer *picture = static_cast<ArvBuffer *>(buffer);
	if (arv_buffer_get_status(picture) != ARV_BUFFER_STATUS_SUCCESS)
		return false;
	size_t size = 0;
	return arv_buffer_get_image_data(picture, &size) && arv_buffer_get_image_width(picture) == width_ &&
	       arv_buffer_get_image_height(picture) == height_ &&
	       size >= static_cast<size_t>(width_) * static_cast<size_t>(height_);
}

int64_t Camera::dated_by_clock(ArvBuffer *buffer)
{
	const std::lock_guard<std::mutex> lock(clock_mutex_);
	return clock_.host_ns(static_cast<int64_t>(arv_buffer_get_timestamp(buffer)));
}

// A picture that comes at the wrong time has the clocks compared before it is believed. None where the clock was set
// just now, and the picture is perhaps from before.
std::optional<int64_t> Camera::exposure_begin_ns(ArvBuffer *buffer)
{
	if (!has_clock_)
		return unix_ns() - exposure_ns_;
	const int64_t first_packet = static_cast<int64_t>(arv_buffer_get_system_timestamp(buffer));
	int64_t begin = dated_by_clock(buffer);
	const bool doubted = clock_doubted_.exchange(false);
	if ((doubted || punctuality_.doubts(first_packet - begin)) && !lost_) {
		read_clock(CLOCK_TRIES_IN_HASTE);
		begin = dated_by_clock(buffer);
		const std::lock_guard<std::mutex> lock(clock_mutex_);
		if (punctuality_.doubts(first_packet - begin) && monotonic_ns() - clock_set_ns_ < SETTLED_NS)
			return std::nullopt;
	}
	punctuality_.learn(first_packet - begin);
	return begin;
}

std::optional<uint32_t> Camera::address() const
{
	ArvDevice *device = arv_camera_get_device(camera_.get());
	if (!ARV_IS_GV_DEVICE(device))
		return std::nullopt;
	GSocketAddress *end = arv_gv_device_get_device_address(ARV_GV_DEVICE(device)); // the device's own
	char *text = g_inet_address_to_string(g_inet_socket_address_get_address(G_INET_SOCKET_ADDRESS(end)));
	const std::optional<uint32_t> address = parse_address(text);
	g_free(text);
	return address;
}

std::string camera_name(pong_side side, const pong_camera &camera)
{
	return std::string(side == PONG_LEFT ? "left" : "right") + " camera " + camera.id;
}

pong_image image_of(void *buffer)
{
	ArvBuffer *picture = static_cast<ArvBuffer *>(buffer);
	size_t size;
	const void *pixels = arv_buffer_get_image_data(picture, &size);
	const int width = arv_buffer_get_image_width(picture), height = arv_buffer_get_image_height(picture);
	return {static_cast<const uint8_t *>(pixels), width, height, width};
}

int camera_of(void *buffer)
{
	return GPOINTER_TO_INT(arv_buffer_get_user_data(static_cast<ArvBuffer *>(buffer)));
}

void free_buffer(void *buffer)
{
	g_object_unref(buffer);
}

} // namespace track
