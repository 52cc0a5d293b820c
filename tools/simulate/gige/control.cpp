#include "control.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "genicam.hpp"
#include "power_on.hpp"

namespace gige
{

namespace
{

constexpr uint32_t packet_size_mask = 0xffff;

std::chrono::steady_clock::time_point to_time_point(int64_t monotonic)
{
	return std::chrono::steady_clock::time_point(std::chrono::nanoseconds(monotonic));
}

} // namespace

Control::Control(const ControlSettings &settings, const FrameRing &ring)
	: settings_(settings), ring_(ring),
	  registers_(register_table(settings.sensor_width, settings.sensor_height),
		     describe(register_table(settings.sensor_width, settings.sensor_height)))
{
	set_identity(registers_, settings_);
	set_defaults(registers_, settings_);
	registers_.set(at::ptp_status, ptp_disabled);
	registers_.set(at::payload_size, static_cast<uint32_t>(payload_size(region(), false)));
}

Answer Control::handle(const uint8_t *bytes, size_t size, const Endpoint &from, int64_t now)
{
	Answer answer;
	Request request;
	if (!parse_request(bytes, size, &request))
		return answer;
	const std::lock_guard<std::mutex> lock(mutex_);
	expire(now);
	if (controller_ == from)
		heard_ = now;
	Bytes data;
	const Status status =
		request.status == Status::success ? execute(request, {from, now, answer}, data) : request.status;
	if (request.wants_reply)
		answer.reply = make_reply(request, status, data);
	answer.destination = destination();
	return answer;
}

Bytes Control::discover(const uint8_t *bytes, size_t size) const
{
	Request request;
	if (!parse_request(bytes, size, &request) || request.command != gvcp::discovery ||
	    request.status != Status::success)
		return {};
	const std::lock_guard<std::mutex> lock(mutex_);
	return make_reply(request, Status::success, registers_.copy(0, at::discovery_end));
}

Status Control::execute(const Request &request, const Writing &writing, Bytes &data)
{
	switch (request.command) {
	case gvcp::discovery:
		data = registers_.copy(0, at::discovery_end);
		return Status::success;
	case gvcp::packet_resend:
		return resend(request, writing);
	case gvcp::read_register:
		return may_read(writing.from) ? read_registers(request, data) : Status::access_denied;
	case gvcp::read_memory:
		return may_read(writing.from) ? read_memory(request, data) : Status::access_denied;
	case gvcp::write_register:
		return write_registers(request, writing, data);
	case gvcp::write_memory:
		return write_memory(request, writing, data);
	default:
		return Status::not_implemented;
	}
}

// Addresses in, values out.
Status Control::read_registers(const Request &request, Bytes &data) const
{
	Status status = Status::success;
	for (size_t i = 0; i < request.size && status == Status::success; i += 4) {
		uint32_t value = 0;
		status = registers_.read(load32(request.data + i), &value);
		if (status == Status::success)
			append32(data, value);
	}
	return status;
}

// Address and 16-bit count in; address and values out.
Status Control::read_memory(const Request &request, Bytes &data) const
{
	const uint32_t address = load32(request.data);
	const size_t count = load16(request.data + 6);
	if (count % 4 || address % 4)
		return Status::bad_alignment;
	if (count == 0 || count > gvcp::max_data - 4)
		return Status::invalid_parameter;
	if (!registers_.has(address, count))
		return Status::invalid_address;
	append32(data, address);
	const Bytes values = registers_.copy(address, count);
	data.insert(data.end(), values.begin(), values.end());
	return Status::success;
}

// Pairs of address and value in; how many were written out.
Status Control::write_registers(const Request &request, const Writing &writing, Bytes &data)
{
	Status status = Status::success;
	uint32_t written = 0;
	while (written < request.size / 8 && status == Status::success) {
		const uint8_t *pair = request.data + size_t{written} * 8;
		status = write(load32(pair), load32(pair + 4), writing);
		if (status == Status::success)
			written++;
	}
	append32(data, written);
	return status;
}

// Address and values in; how many bytes were written out. All that can be written is a whole word.
Status Control::write_memory(const Request &request, const Writing &writing, Bytes &data)
{
	Status status = request.size % 4 ? Status::bad_alignment : Status::success;
	const uint32_t address = load32(request.data);
	uint32_t written = 0;
	while (written < request.size - 4 && status == Status::success) {
		status = write(address + written, load32(request.data + 4 + written), writing);
		if (status == Status::success)
			written += 4;
	}
	append32(data, written);
	return status;
}

// Stream channel, frame id, first packet, last packet in; the packets leave on the stream. Only the host that gets the
// stream may ask, from any port: clients do it from the stream's own socket.
Status Control::resend(const Request &request, const Writing &writing) const
{
	if (writing.from.address != destination().address)
		return Status::access_denied;
	if (load16(request.data) != 0)
		return Status::invalid_parameter;
	writing.answer.stream = ring_.resend(load16(request.data + 2), load32(request.data + 4) & 0xffffff,
					     load32(request.data + 8) & 0xffffff);
	return Status::success;
}

Status Control::write(uint32_t address, uint32_t value, const Writing &writing)
{
	const bool takes_control = address == at::control_privilege && !controller_;
	if (!takes_control && !(controller_ == writing.from))
		return Status::access_denied;
	Status status = check(address, value);
	if (status == Status::success)
		status = registers_.write(address, value);
	if (status == Status::success)
		take_effect(address, value, writing);
	return status;
}

// The rules that the register table cannot tell.
Status Control::check(uint32_t address, uint32_t value) const
{
	const Register *place = registers_.find(address);
	if (place && place->when == When::while_not_streaming && session_)
		return Status::busy;
	const uint64_t number = value;
	const Region now = region();
	const auto sensor_width = static_cast<uint32_t>(settings_.sensor_width);
	const auto sensor_height = static_cast<uint32_t>(settings_.sensor_height);
	const uint32_t packet_size = value & packet_size_mask;
	bool is_good = true;
	if (address == at::width)
		is_good = number + now.x <= sensor_width;
	else if (address == at::height)
		is_good = number + now.y <= sensor_height;
	else if (address == at::offset_x)
		is_good = number + now.width <= sensor_width;
	else if (address == at::offset_y)
		is_good = number + now.height <= sensor_height;
	else if (address == at::stream_packet_size)
		is_good = packet_size >= gvsp::min_packet_size && packet_size <= gvsp::max_packet_size &&
			  packet_size % gvsp::packet_size_step == 0;
	return is_good ? Status::success : Status::invalid_parameter;
}

void Control::take_effect(uint32_t address, uint32_t value, const Writing &writing)
{
	switch (address) {
	case at::control_privilege:
		set_privilege(value, writing);
		break;
	case at::timestamp_control:
		registers_.set64(at::latched_timestamp, device_time(writing.now));
		break;
	case at::stream_packet_size:
		registers_.set(address, value & packet_size_mask);
		if (value & fire_test_packet_now)
			fire_test_packet(writing.answer);
		break;
	case at::acquisition_start:
		start();
		break;
	case at::acquisition_stop:
		stop();
		break;
	case at::ptp_enable: // its clock is the host's anyway, but for what a fault adds
		registers_.set(at::ptp_status, value ? ptp_slave : ptp_disabled);
		break;
	case at::trigger_software:
		software_triggers_++;
		break;
	default:
		break;
	}
	if (registers_.find(address)->kind == Kind::command)
		registers_.set(address, 0); // done
	registers_.set(at::payload_size,
		       static_cast<uint32_t>(payload_size(region(), registers_.get(at::chunk_mode) != 0)));
	notify_change();
}

void Control::set_privilege(uint32_t privilege, const Writing &writing)
{
	if (privilege == 0) {
		release();
		return;
	}
	controller_ = writing.from;
	heard_ = writing.now;
}

// A packet of the whole size that must come through in one piece; what it holds doesn't matter.
void Control::fire_test_packet(Answer &answer)
{
	const size_t size = registers_.get(at::stream_packet_size) & packet_size_mask;
	answer.stream.emplace_back(size - gvsp::ip_udp_size);
}

void Control::start()
{
	if (session_)
		return;
	session_ = ++sessions_;
	software_triggers_ = 0;
}

void Control::stop()
{
	session_ = 0;
}

// The settings stay as the client left them.
void Control::release()
{
	controller_.reset();
	stop();
	registers_.set(at::control_privilege, 0);
	registers_.set(at::stream_port, 0);
	notify_change();
}

void Control::notify_change()
{
	changes_++;
	change_.notify_all();
}

void Control::expire(int64_t now)
{
	const int64_t timeout = int64_t{registers_.get(at::heartbeat_timeout)} * 1000000;
	if (controller_ && now - heard_ > timeout)
		release();
}

void Control::check_heartbeat(int64_t now)
{
	const std::lock_guard<std::mutex> lock(mutex_);
	expire(now);
}

void Control::leave_held(int64_t now)
{
	const std::lock_guard<std::mutex> lock(mutex_);
	controller_ = Endpoint{}; // nobody's address
	heard_ = now;
	registers_.set(at::control_privilege, control_privilege);
}

bool Control::may_read(const Endpoint &from) const
{
	return !controller_ || controller_ == from || !(registers_.get(at::control_privilege) & exclusive_privilege);
}

bool Control::is_controlled() const
{
	const std::lock_guard<std::mutex> lock(mutex_);
	return controller_.has_value();
}

Region Control::region() const
{
	return {registers_.get(at::width), registers_.get(at::height), registers_.get(at::offset_x),
		registers_.get(at::offset_y)};
}

Endpoint Control::destination() const
{
	return {registers_.get(at::stream_address), static_cast<uint16_t>(registers_.get(at::stream_port))};
}

Acquisition Control::acquisition() const
{
	const std::lock_guard<std::mutex> lock(mutex_);
	Acquisition now;
	now.changes = changes_;
	now.session = session_;
	now.is_triggered = registers_.get(at::trigger_mode) != 0;
	now.by_line = registers_.get(at::trigger_source) == source_line1;
	now.software_triggers = software_triggers_;
	now.frame_rate = registers_.get_real(at::frame_rate);
	now.exposure = registers_.get_real(at::exposure_time) / 1e6;
	now.gain = registers_.get_real(at::gain);
	now.region = region();
	now.has_chunks = registers_.get(at::chunk_mode) != 0;
	now.is_single_frame = registers_.get(at::acquisition_mode) == mode_single_frame;
	now.packet_size = registers_.get(at::stream_packet_size) & packet_size_mask;
	now.packet_delay = registers_.get(at::stream_packet_delay);
	now.destination = destination();
	return now;
}

void Control::set_stream_source_port(uint16_t port)
{
	const std::lock_guard<std::mutex> lock(mutex_);
	registers_.set(at::stream_source_port, port);
}

void Control::finish(uint64_t session)
{
	const std::lock_guard<std::mutex> lock(mutex_);
	if (session_ == session)
		stop();
	notify_change();
}

bool Control::wait_in_session(int64_t time, uint64_t session)
{
	std::unique_lock<std::mutex> lock(mutex_);
	return !change_.wait_until(lock, to_time_point(time), [&] { return session_ != session; });
}

void Control::wait_for_change(int64_t time, const Acquisition &seen)
{
	std::unique_lock<std::mutex> lock(mutex_);
	change_.wait_until(lock, to_time_point(time), [&] { return changes_ != seen.changes; });
}

void Control::notify()
{
	const std::lock_guard<std::mutex> lock(mutex_);
	notify_change();
}

uint64_t Control::device_time(int64_t time) const
{
	const int64_t since = time - settings_.power_on;
	return static_cast<uint64_t>(since + std::llround(1e-6 * settings_.drift * static_cast<double>(since)) +
				     clock_step_);
}

} // namespace gige
