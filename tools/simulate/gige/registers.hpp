// A camera's registers: what there is (the table, which the GenICam description is written from as well), and the
// memory that holds their values.
#pragma once

#include <string>
#include <vector>

#include "bytes.hpp"
#include "protocol.hpp"

namespace gige
{

// Addresses: the bootstrap registers are GigE Vision's, those from 0xa000 on are ours.
namespace at
{
enum Address : uint32_t {
	version = 0x0000,
	device_mode = 0x0004,
	mac_high = 0x0008,
	mac_low = 0x000c,
	supported_ip_configuration = 0x0010,
	current_ip_configuration = 0x0014,
	ip_address = 0x0024,
	subnet_mask = 0x0034,
	manufacturer = 0x0048,
	model = 0x0068,
	device_version = 0x0088,
	manufacturer_info = 0x00a8,
	serial_number = 0x00d8,
	discovery_end = 0x00f8,
	description_url = 0x0200,
	network_interfaces = 0x0600,
	stream_channels = 0x0904,
	capabilities = 0x0934,
	heartbeat_timeout = 0x0938, // ms
	tick_frequency = 0x093c,    // 64 bit, Hz
	timestamp_control = 0x0944,
	latched_timestamp = 0x0948, // 64 bit, ticks
	control_privilege = 0x0a00,
	stream_port = 0x0d00,
	stream_packet_size = 0x0d04,
	stream_packet_delay = 0x0d08, // ticks
	stream_address = 0x0d18,
	stream_source_port = 0x0d1c,

	sensor_width = 0xa000,
	sensor_height = 0xa004,
	width = 0xa008,
	height = 0xa00c,
	offset_x = 0xa010,
	offset_y = 0xa014,
	pixel_format = 0xa018,
	acquisition_mode = 0xa100,
	acquisition_start = 0xa104,
	acquisition_stop = 0xa108,
	frame_rate_enable = 0xa10c,
	frame_rate = 0xa110, // Hz, while not triggered
	trigger_selector = 0xa120,
	trigger_mode = 0xa124,
	trigger_source = 0xa128,
	trigger_activation = 0xa12c,
	trigger_software = 0xa130,
	exposure_mode = 0xa140,
	exposure_time = 0xa144, // us
	gain = 0xa150,          // dB
	chunk_mode = 0xa160,
	payload_size = 0xa170,
	ptp_enable = 0xa180,
	ptp_status = 0xa184,

	description = 0x10000,
};
} // namespace at

// Fields of some registers.
constexpr uint32_t exclusive_privilege = 1, control_privilege = 2; // control_privilege
constexpr uint32_t fire_test_packet_now = 0x80000000;              // stream_packet_size
constexpr uint32_t latch_timestamp = 2;                            // timestamp_control
constexpr uint32_t mode_continuous = 0, mode_single_frame = 1;     // acquisition_mode
constexpr uint32_t ptp_disabled = 4, ptp_slave = 9;       // ptp_status: any numbers, the description names them
constexpr uint32_t source_software = 0, source_line1 = 1; // trigger_source

enum class Kind { integer, real, boolean, enumeration, command, text };
enum class Access { read, write };               // write: and read
enum class When { always, while_not_streaming }; // when it may be written

struct Entry {
	const char *name;
	uint32_t value;
};

struct Register {
	const char *category; // of its GenICam feature; empty: has none
	const char *name;
	Kind kind;
	uint32_t address;
	uint32_t length; // bytes
	Access access = Access::read;
	double min = 0, max = 0, step = 1; // of a written number; a command's one value is max
	When when = When::always;
	const char *unit = "";
	std::vector<Entry> entries = {};
	const char *max_less = "", *max_of = ""; // features: the maximum is max_of - max_less (and max holds as well)
};

// Every register that a client may write, or that is a GenICam feature.
std::vector<Register> register_table(int sensor_width, int sensor_height);

// The memory behind the registers, and the rules of the table. Not for several threads at once.
class RegisterFile
{
public:
	RegisterFile(std::vector<Register> table, const std::string &description);

	// As a client does, a 32-bit word at a time: alignment, addresses, access and limits are checked.
	Status read(uint32_t address, uint32_t *value) const;
	Status write(uint32_t address, uint32_t value);

	// The register that holds this word; nullptr: none of the table.
	const Register *find(uint32_t address) const;

	bool has(uint32_t address, size_t length) const;

	// The size of the description, padding included.
	size_t description_size() const;

	// As the camera itself does, unchecked: the memory must have the address.
	Bytes copy(uint32_t address, size_t length) const;
	uint32_t get(uint32_t address) const;
	float get_real(uint32_t address) const;
	void set(uint32_t address, uint32_t value);
	void set_real(uint32_t address, float value);
	void set64(uint32_t address, uint64_t value);
	void set_text(uint32_t address, const std::string &text);

private:
	std::vector<Register> table_;
	Bytes memory_; // all registers, and the description behind them
};

} // namespace gige
