#include "aravis_camera.hpp"

#include <cmath>
#include <utility>

#include "program.hpp"

namespace track
{

namespace
{

constexpr int BUFFERS = 64; // of a stream: more than are ever waiting to be tracked, so that it never runs dry
constexpr int STREAM_PRIORITY = 10;

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

	// Throws where the last call failed.
	void check(const std::string &camera, const char *what) const
	{
		if (error_)
			throw pong::Failure(camera + ": " + what + ": " + text());
	}

private:
	GError *error_ = nullptr;
};

void on_control_lost(ArvDevice *, std::atomic<bool> *lost)
{
	*lost = true;
}

} // namespace

Camera::Camera(pong_side side, const pong_camera &camera, const CaptureSettings &settings, Receive receive)
	: side_(side), name_(std::string(side == PONG_LEFT ? "left" : "right") + " camera " + camera.id),
	  receive_(std::move(receive))
{
	open(camera.id);
	set_picture(camera);
	set_exposure(settings);
	set_trigger(settings);
	set_packets(settings);
	find_clock();
	open_stream();
}

Camera::~Camera()
{
	if (!lost_)
		arv_camera_stop_acquisition(camera_.get(), nullptr);
	g_signal_handlers_disconnect_by_data(arv_camera_get_device(camera_.get()), &lost_);
}

void Camera::open(const char *id)
{
	Fault fault;
	camera_.reset(arv_camera_new(id, fault));
	if (!camera_)
		throw pong::Failure(name_ + ": not found: no GigE Vision camera on any network interface and no USB3 " +
				    "Vision camera has this address, serial number or id (" + fault.text() +
				    "; pongeye-track --list shows those that answer)");
	ArvDevice *device = arv_camera_get_device(camera_.get());
	// Aravis opens a camera that another program controls, too, and then every setting fails.
	if (ARV_IS_GV_DEVICE(device) && !arv_gv_device_is_controller(ARV_GV_DEVICE(device)))
		throw pong::Failure(name_ + ": another program controls it");
	g_signal_connect(device, "control-lost", G_CALLBACK(on_control_lost), &lost_);
}

// The calibration holds for the picture that it was made with: any other size is an error.
void Camera::set_picture(const pong_camera &camera)
{
	Fault fault;
	arv_camera_set_pixel_format(camera_.get(), ARV_PIXEL_FORMAT_MONO_8, fault);
	fault.check(name_, "cannot send grey pictures of 8 bits (Mono8)");
	arv_camera_set_region(camera_.get(), 0, 0, camera.width, camera.height, fault);
	const std::string size =
		pong::format("cannot send %d x %d pixels, the size in rig.toml", camera.width, camera.height);
	fault.check(name_, size.c_str());
	int x, y, width, height;
	arv_camera_get_region(camera_.get(), &x, &y, &width, &height, fault);
	fault.check(name_, "does not tell its picture size");
	if (width != camera.width || height != camera.height)
		throw pong::Failure(name_ + ": " + size + pong::format(", but %d x %d", width, height));
}

// Automatic exposure and gain are switched off where there are any: the ball's brightness must not depend on the rest.
void Camera::set_exposure(const CaptureSettings &settings)
{
	Fault fault;
	ArvCamera *camera = camera_.get();
	if (arv_camera_is_exposure_auto_available(camera, nullptr))
		arv_camera_set_exposure_time_auto(camera, ARV_AUTO_OFF, nullptr);
	if (settings.exposure > 0) {
		arv_camera_set_exposure_time(camera, settings.exposure * 1e6, fault);
		fault.check(name_, "cannot set the exposure");
	}
	exposure_ns_ = std::llround(arv_camera_get_exposure_time(camera, fault) * 1e3);
	fault.check(name_, "does not tell its exposure");
	if (!settings.has_gain)
		return;
	if (arv_camera_is_gain_auto_available(camera, nullptr))
		arv_camera_set_gain_auto(camera, ARV_AUTO_OFF, nullptr);
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
}

void Camera::find_clock()
{
	has_clock_ = arv_camera_is_feature_available(camera_.get(), "TimestampLatch", nullptr) &&
		     arv_camera_is_feature_available(camera_.get(), "TimestampLatchValue", nullptr);
	if (has_clock_)
		read_clock();
	else
		pong::say(name_ + ": it has no TimestampLatch: times are those of the pictures' arrival, "
				  "less the exposure");
}

// The fastest of several round trips says most about when the latch happened.
void Camera::read_clock()
{
	if (!has_clock_)
		return;
	constexpr int TRIES = 8;
	ClockReading best = {};
	for (int i = 0; i < TRIES; i++) {
		Fault fault;
		ClockReading reading;
		reading.before_ns = unix_ns();
		arv_camera_execute_command(camera_.get(), "TimestampLatch", fault);
		reading.after_ns = unix_ns();
		if (!fault.failed())
			reading.device_ns = arv_camera_get_integer(camera_.get(), "TimestampLatchValue", fault);
		if (fault.failed())
			return;
		if (i == 0 || reading.round_trip_ns() < best.round_trip_ns())
			best = reading;
	}
	const std::lock_guard<std::mutex> lock(clock_mutex_);
	clock_.add(best);
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
		arv_stream_push_buffer(stream_.get(), arv_buffer_new(payload, nullptr));
}

void Camera::start()
{
	Fault fault;
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
	if (arv_buffer_get_status(buffer) != ARV_BUFFER_STATUS_SUCCESS) {
		incomplete_++;
		give_back(buffer);
		return;
	}
	const int64_t arrival_ns = monotonic_ns();
	if (!receive_(side_, {(exposure_begin_ns(buffer) + exposure_ns_ / 2) / 1000, arrival_ns, buffer})) {
		late_++;
		give_back(buffer);
	}
}

int64_t Camera::exposure_begin_ns(ArvBuffer *buffer)
{
	if (!has_clock_)
		return unix_ns() - exposure_ns_;
	const std::lock_guard<std::mutex> lock(clock_mutex_);
	return clock_.host_ns(static_cast<int64_t>(arv_buffer_get_timestamp(buffer)));
}

void make_thread_realtime(int priority)
{
	static std::once_flag warned;
	if (!arv_make_thread_realtime(priority))
		std::call_once(warned, [] {
			pong::say(
				"no real-time priority, which this user may not have: under load pictures come later");
		});
}

pong_image image_of(void *buffer)
{
	ArvBuffer *picture = static_cast<ArvBuffer *>(buffer);
	size_t size;
	const void *pixels = arv_buffer_get_image_data(picture, &size);
	const int width = arv_buffer_get_image_width(picture), height = arv_buffer_get_image_height(picture);
	return {static_cast<const uint8_t *>(pixels), width, height, width};
}

void free_buffer(void *buffer)
{
	g_object_unref(buffer);
}

} // namespace track
