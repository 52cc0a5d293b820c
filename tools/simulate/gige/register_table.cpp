// The one list of what a client may set and read, by GenICam's standard feature names (SFNC).
#include "registers.hpp"

namespace gige
{

namespace
{

const char *device = "DeviceControl", *image = "ImageFormatControl", *acquisition = "AcquisitionControl",
	   *analog = "AnalogControl", *chunks = "ChunkDataControl", *transport = "TransportLayerControl", *hidden = "";

Register text(const char *name, uint32_t address, uint32_t length)
{
	return {device, name, Kind::text, address, length};
}

Register reading(const char *category, const char *name, uint32_t address, uint32_t length = 4)
{
	return {category, name, Kind::integer, address, length};
}

Register integer(const char *category, const char *name, uint32_t address, double min, double max)
{
	return {category, name, Kind::integer, address, 4, Access::write, min, max};
}

Register real(const char *category, const char *name, uint32_t address, double min, double max, const char *unit)
{
	return {category, name, Kind::real, address, 4, Access::write, min, max, 0, When::always, unit};
}

Register boolean(const char *category, const char *name, uint32_t address, When when)
{
	return {category, name, Kind::boolean, address, 4, Access::write, 0, 1, 1, when};
}

Register choice(const char *category, const char *name, uint32_t address, std::vector<Entry> entries)
{
	return {category,
		name,
		Kind::enumeration,
		address,
		4,
		Access::write,
		0,
		0,
		1,
		When::while_not_streaming,
		"",
		std::move(entries)};
}

Register state(const char *category, const char *name, uint32_t address, std::vector<Entry> entries)
{
	Register state = choice(category, name, address, std::move(entries));
	state.access = Access::read;
	return state;
}

Register command(const char *category, const char *name, uint32_t address, uint32_t value = 1)
{
	return {category, name, Kind::command, address, 4, Access::write, 0, static_cast<double>(value)};
}

// One side of the region of interest, px. The region must stay on the sensor.
Register side(const char *name, uint32_t address, double min, double max, const char *max_of, const char *max_less)
{
	Register side = integer(image, name, address, min, max);
	side.step = 4;
	side.when = When::while_not_streaming;
	side.max_of = max_of;
	side.max_less = max_less;
	return side;
}

} // namespace

std::vector<Register> register_table(int sensor_width, int sensor_height)
{
	const double any = 0xffffffff;
	return {
		text("DeviceVendorName", at::manufacturer, 32),
		text("DeviceModelName", at::model, 32),
		text("DeviceVersion", at::device_version, 32),
		text("DeviceManufacturerInfo", at::manufacturer_info, 48),
		text("DeviceSerialNumber", at::serial_number, 16),
		command(device, "TimestampLatch", at::timestamp_control, latch_timestamp),
		reading(device, "TimestampLatchValue", at::latched_timestamp, 8),
		boolean(device, "PtpEnable", at::ptp_enable, When::always),
		state(device, "PtpStatus", at::ptp_status, {{"Disabled", ptp_disabled}, {"Slave", ptp_slave}}),

		reading(image, "SensorWidth", at::sensor_width),
		reading(image, "SensorHeight", at::sensor_height),
		side("Width", at::width, 16, sensor_width, "SensorWidth", "OffsetX"),
		side("Height", at::height, 16, sensor_height, "SensorHeight", "OffsetY"),
		side("OffsetX", at::offset_x, 0, sensor_width, "SensorWidth", "Width"),
		side("OffsetY", at::offset_y, 0, sensor_height, "SensorHeight", "Height"),
		choice(image, "PixelFormat", at::pixel_format, {{"Mono8", gvsp::mono8}}),

		choice(acquisition, "AcquisitionMode", at::acquisition_mode,
		       {{"Continuous", mode_continuous}, {"SingleFrame", mode_single_frame}}),
		command(acquisition, "AcquisitionStart", at::acquisition_start),
		command(acquisition, "AcquisitionStop", at::acquisition_stop),
		boolean(acquisition, "AcquisitionFrameRateEnable", at::frame_rate_enable, When::always),
		real(acquisition, "AcquisitionFrameRate", at::frame_rate, 1, 1000, "Hz"),
		choice(acquisition, "TriggerSelector", at::trigger_selector, {{"FrameStart", 0}}),
		choice(acquisition, "TriggerMode", at::trigger_mode, {{"Off", 0}, {"On", 1}}),
		choice(acquisition, "TriggerSource", at::trigger_source,
		       {{"Software", source_software}, {"Line1", source_line1}}),
		choice(acquisition, "TriggerActivation", at::trigger_activation, {{"RisingEdge", 0}}),
		command(acquisition, "TriggerSoftware", at::trigger_software),
		choice(acquisition, "ExposureMode", at::exposure_mode, {{"Timed", 0}}),
		real(acquisition, "ExposureTime", at::exposure_time, 10, 1000000, "us"),
		real(analog, "Gain", at::gain, 0, 24, "dB"),

		boolean(chunks, "ChunkModeActive", at::chunk_mode, When::while_not_streaming),

		reading(transport, "PayloadSize", at::payload_size),
		reading(transport, "GevTimestampTickFrequency", at::tick_frequency, 8),
		integer(transport, "GevHeartbeatTimeout", at::heartbeat_timeout, 500, 60000),
		integer(transport, "GevSCPD", at::stream_packet_delay, 0, 1000000),
		integer(hidden, "GevCCP", at::control_privilege, 0, exclusive_privilege | control_privilege),
		integer(hidden, "GevSCPHostPort", at::stream_port, 0, 0xffff),
		integer(hidden, "GevSCDA", at::stream_address, 0, any),
		integer(hidden, "GevSCPS", at::stream_packet_size, 0, any), // of fields: the camera checks them
	};
}

} // namespace gige
