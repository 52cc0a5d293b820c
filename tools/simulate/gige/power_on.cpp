#include "power_on.hpp"

#include "program.hpp"

namespace gige
{

void set_identity(RegisterFile &registers, const ControlSettings &settings)
{
	registers.set(at::version, 0x00010002);     // GigE Vision 1.2
	registers.set(at::device_mode, 0x80000001); // big-endian, UTF-8
	registers.set(at::mac_high, 0x0200);        // a locally administered address, made of the IP address
	registers.set(at::mac_low, settings.address);
	registers.set(at::supported_ip_configuration, 0x5); // link-local and persistent
	registers.set(at::current_ip_configuration, 0x5);
	registers.set(at::ip_address, settings.address);
	registers.set(at::subnet_mask, 0xff000000);
	registers.set_text(at::manufacturer, "Pongeye");
	registers.set_text(at::model, "Simulated");
	registers.set_text(at::device_version, "1");
	registers.set_text(at::manufacturer_info, "a simulated camera");
	registers.set_text(at::serial_number, settings.serial.substr(0, 15));
	registers.set_text(at::description_url,
			   pong::format("Local:pongeye.xml;%x;%zx", at::description, registers.description_size()));
	registers.set(at::network_interfaces, 1);
	registers.set(at::stream_channels, 1);
	registers.set(at::capabilities, 0x40000007); // concatenation, WRITEMEM, PACKETRESEND, serial number
	registers.set64(at::tick_frequency, 1000000000);
}

void set_defaults(RegisterFile &registers, const ControlSettings &settings)
{
	registers.set(at::heartbeat_timeout, 3000);
	registers.set(at::stream_packet_size, gvsp::max_packet_size); // which loopback carries
	registers.set(at::sensor_width, static_cast<uint32_t>(settings.sensor_width));
	registers.set(at::sensor_height, static_cast<uint32_t>(settings.sensor_height));
	registers.set(at::width, static_cast<uint32_t>(settings.sensor_width));
	registers.set(at::height, static_cast<uint32_t>(settings.sensor_height));
	registers.set(at::pixel_format, gvsp::mono8);
	registers.set(at::frame_rate_enable, 1);
	registers.set_real(at::frame_rate, 30);
	registers.set(at::trigger_source, source_line1);
	registers.set_real(at::exposure_time, static_cast<float>(settings.exposure * 1e6));
}

} // namespace gige
