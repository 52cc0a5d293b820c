#include "recording.hpp"

#include <arv.h>
#include <lcm/lcm.h>
#include <opencv2/core/version.hpp>
#include <sys/utsname.h>

#include "capture_settings.hpp"
#include "clock.hpp"
#include "images.hpp"
#include "program.hpp"
#include "save_request.hpp"
#include "trigger_listener.hpp"

namespace track
{

namespace
{

std::string libraries()
{
	utsname system = {};
	uname(&system);
	return pong::format("LCM %d.%d.%d, Aravis %d.%d.%d, OpenCV %s, %s %s %s", LCM_MAJOR_VERSION, LCM_MINOR_VERSION,
			    LCM_MICRO_VERSION, ARAVIS_MAJOR_VERSION, ARAVIS_MINOR_VERSION, ARAVIS_MICRO_VERSION,
			    CV_VERSION, system.sysname, system.release, system.machine);
}

pongeye::recording_t header(const Setup &setup)
{
	pongeye::recording_t header;
	header.utime = unix_ns() / 1000;
	header.version = PONG_VERSION;
	header.libraries = libraries();
	header.profile = setup.profile == PONG_PAPER ? "paper" : "best";
	header.rig_name = setup.rig_text.name;
	header.rig = setup.rig_text.text;
	return header;
}

double pair_rate(const Arguments &arguments)
{
	if (arguments.from_cameras())
		return load_capture_settings(arguments.rig).rate;
	return arguments.fps;
}

RecordSettings record_settings(const Arguments &arguments)
{
	RecordSettings settings;
	settings.path = arguments.record;
	settings.what = arguments.record_what;
	settings.last = arguments.record_last;
	settings.rate = pair_rate(arguments);
	settings.live = arguments.from_cameras();
	return settings;
}

} // namespace

Recording::Recording(const Arguments &arguments, const Setup &setup, Publisher &publisher)
	: saves_on_request_(arguments.record_last > 0),
	  recorder_(record_settings(arguments), header(setup), setup.rig, setup.settings)
{
	publisher.record_to(recorder_);
	if (arguments.from_cameras() && TriggerListener::can_hear(publisher.url()))
		overheard_ = std::make_unique<Overheard>(publisher.url());
	if (saves_on_request_)
		listen_for_save_requests();
}

void Recording::listen()
{
	bool asked = saves_on_request_ && save_requested();
	for (Overheard::Message message; overheard_ && overheard_->take(message);) {
		if (message.size > 0)
			recorder_.add_message(message.channel, 0, message.data, message.size);
		asked |= message.asks_to_save;
	}
	if (asked)
		recorder_.save();
}

bool Recording::finish()
{
	const std::string summary = recorder_.finish();
	if (!summary.empty())
		pong::say(summary);
	return recorder_.good();
}

} // namespace track
