#include <algorithm>
#include <arv.h>
#include <cstdio>
#include <string>

#include "cameras.hpp"
#include "program.hpp"

namespace track
{

namespace
{

// One cell of a table has no blanks.
std::string cell(const char *text)
{
	std::string word = text && *text ? text : "-";
	std::replace(word.begin(), word.end(), ' ', '_');
	return word;
}

// What a camera is set to, by the names of GenICam. A camera that another program controls may be looked at, too.
class Look
{
public:
	explicit Look(const char *id) : camera_(arv_camera_new(id, nullptr))
	{
	}

	~Look()
	{
		g_clear_object(&camera_);
	}

	Look(const Look &) = delete;
	Look &operator=(const Look &) = delete;

	std::string word(const char *feature) const
	{
		return has(feature) ? cell(arv_camera_get_string(camera_, feature, nullptr)) : "-";
	}

	std::string integer(const char *feature) const
	{
		if (!has(feature))
			return "-";
		return std::to_string(arv_camera_get_integer(camera_, feature, nullptr));
	}

	std::string number(const char *feature) const
	{
		return has(feature) ? pong::format("%g", arv_camera_get_float(camera_, feature, nullptr)) : "-";
	}

	std::string trigger() const
	{
		const std::string mode = word("TriggerMode");
		return mode == "On" ? word("TriggerSource") + "," + word("TriggerActivation") : mode;
	}

	// How its clock can be compared with others, and whether it follows one: Slave, Master, Disabled and others.
	std::string clock() const
	{
		if (has("PtpStatus"))
			return "ptp," + word("PtpStatus");
		if (has("GevIEEE1588Status"))
			return "ptp," + word("GevIEEE1588Status");
		return has("TimestampLatch") ? "latch" : "-";
	}

	// Of GigE Vision: who has its control.
	std::string use() const
	{
		if (!camera_)
			return "-";
		ArvDevice *device = arv_camera_get_device(camera_);
		return ARV_IS_GV_DEVICE(device) && !arv_gv_device_is_controller(ARV_GV_DEVICE(device)) ? "in_use"
												       : "free";
	}

private:
	bool has(const char *feature) const
	{
		return camera_ && arv_camera_is_feature_available(camera_, feature, nullptr);
	}

	ArvCamera *camera_;
};

void print_settings(const char *id)
{
	const Look look(id);
	printf(" %s %s %s %s %s %s %s %s %s\n", look.use().c_str(), look.integer("Width").c_str(),
	       look.integer("Height").c_str(), look.word("PixelFormat").c_str(), look.number("ExposureTime").c_str(),
	       look.number("Gain").c_str(), look.trigger().c_str(), look.integer("GevSCPSPacketSize").c_str(),
	       look.clock().c_str());
}

} // namespace

void list_cameras()
{
	arv_update_device_list();
	const unsigned count = arv_get_n_devices();
	if (count == 0)
		throw pong::Failure(
			"no GigE Vision camera answers on any network interface, and there is no USB3 Vision "
			"camera");
	printf("# address serial protocol vendor model id use width height format exposure_us gain trigger packet_size "
	       "clock\n");
	for (unsigned i = 0; i < count; i++) {
		printf("%s %s %s %s %s %s", cell(arv_get_device_address(i)).c_str(),
		       cell(arv_get_device_serial_nbr(i)).c_str(), cell(arv_get_device_protocol(i)).c_str(),
		       cell(arv_get_device_vendor(i)).c_str(), cell(arv_get_device_model(i)).c_str(),
		       cell(arv_get_device_id(i)).c_str());
		print_settings(arv_get_device_id(i));
	}
}

} // namespace track
