#include "publisher.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "clock.hpp"
#include "program.hpp"
#include "recorder.hpp"

namespace track
{

namespace
{

constexpr char LCM_DEFAULT_URL[] = "udpm://239.255.76.67:7667?ttl=0";

// As LCM chooses it.
std::string url_or_default(const std::string &url)
{
	if (!url.empty())
		return url;
	const char *environment = getenv("LCM_DEFAULT_URL");
	return environment && *environment ? environment : LCM_DEFAULT_URL;
}

// The address of "udpm://ADDRESS:PORT?options"; each part may be left out.
in_addr multicast_address(const std::string &url, size_t begin)
{
	const std::string text = url.substr(begin, url.find_first_of(":?", begin) - begin);
	in_addr address;
	if (inet_pton(AF_INET, text.empty() ? "239.255.76.67" : text.c_str(), &address) != 1)
		throw pong::Failure("LCM URL " + url + ": '" + text + "' is no multicast address");
	return address;
}

// LCM's own words on this are many, and its remedy is for programs that today's systems do not have.
void check_multicast_route(const std::string &url)
{
	constexpr char SCHEME[] = "udpm://";
	if (url.rfind(SCHEME, 0) != 0)
		return;
	sockaddr_in target = {};
	target.sin_family = AF_INET;
	target.sin_port = htons(7667);
	target.sin_addr = multicast_address(url, strlen(SCHEME));
	const int probe = socket(AF_INET, SOCK_DGRAM, 0);
	const bool routed = connect(probe, reinterpret_cast<sockaddr *>(&target), sizeof target) == 0;
	const int error = errno;
	close(probe);
	if (!routed)
		throw pong::Failure("LCM URL " + url + ": no route for multicast (" + strerror(error) +
				    "): `ip route add 224.0.0.0/4 dev lo` makes one on this machine, "
				    "or choose another way by --lcm-url");
}

} // namespace

Publisher::Publisher(const std::string &url) : url_(url_or_default(url))
{
	if (url_.find("://") == std::string::npos)
		throw pong::Failure("LCM URL " + url_ + ": it has no provider, such as udpm:// or memq://");
	check_multicast_route(url_);
	lcm_ = std::make_unique<lcm::LCM>(url_);
	if (!lcm_->good())
		throw pong::Failure("LCM URL " + url_ + ": LCM cannot open it");
	prediction_.path_utime.reserve(PONG_PATH_CAPACITY);
	prediction_.path_position.reserve(PONG_PATH_CAPACITY);
}

// pair_utime: of the pair that it tells of; 0: of none.
template<class Message> void Publisher::send(const char *channel, const Message &message, int64_t pair_utime)
{
	encoded_.resize(static_cast<size_t>(message.getEncodedSize()));
	const int size = message.encode(encoded_.data(), 0, static_cast<int>(encoded_.size()));
	if (lcm_->publish(channel, encoded_.data(), static_cast<unsigned>(size)) != 0)
		throw pong::Failure(std::string("LCM cannot publish on ") + channel + ": " + strerror(errno));
	if (recorder_)
		recorder_->add_message(channel, pair_utime, encoded_.data(), encoded_.size());
}

namespace
{

void fill(const pong_ball &ball, pongeye::ball_t &message)
{
	message.utime = ball.utime;
	message.frame = ball.frame;
	message.track = ball.track;
	std::copy_n(ball.position, 3, message.position);
	std::copy_n(ball.velocity, 3, message.velocity);
	std::copy_n(&ball.covariance[0][0], 9, &message.covariance[0][0]);
	message.left[0] = ball.centre[PONG_LEFT].u;
	message.left[1] = ball.centre[PONG_LEFT].v;
	message.right[0] = ball.centre[PONG_RIGHT].u;
	message.right[1] = ball.centre[PONG_RIGHT].v;
	message.epipolar_distance = ball.epipolar_distance;
	message.radius = ball.centre[PONG_LEFT].radius;
}

// What is not there is zero, not what the last message had.
void fill(const pong_prediction &prediction, pongeye::prediction_t &message)
{
	const pong_state none = {};
	const pong_state &hit = prediction.has_hit ? prediction.hit : none;
	message.has_hit = prediction.has_hit != 0;
	message.hit_utime = hit.utime;
	std::copy_n(hit.position, 3, message.hit_position);
	std::copy_n(hit.velocity, 3, message.hit_velocity);
	std::copy_n(&prediction.hit_covariance[0][0], 16, &message.hit_covariance[0][0]);

	const pong_state &bounce = prediction.has_bounce ? prediction.bounce : none;
	message.has_bounce = prediction.has_bounce != 0;
	message.bounce_utime = bounce.utime;
	std::copy_n(bounce.position, 3, message.bounce_position);

	std::copy_n(prediction.spin, 3, message.spin);
}

void fill_path(const pong_prediction &prediction, pongeye::prediction_t &message)
{
	const size_t count = static_cast<size_t>(prediction.path_count);
	message.path_count = prediction.path_count;
	message.path_utime.resize(count);
	message.path_position.resize(count);
	for (size_t i = 0; i < count; i++) {
		message.path_utime[i] = prediction.path[i].utime;
		message.path_position[i].assign(prediction.path[i].position, prediction.path[i].position + 3);
	}
}

} // namespace

void Publisher::publish_ball(const pong_sight &sight)
{
	if (!sight.has_ball)
		return;
	fill(sight.ball, ball_);
	send("PONGEYE_BALL", ball_, ball_.utime);
}

void Publisher::publish_prediction(const pong_sight &sight)
{
	if (!sight.has_prediction)
		return;
	prediction_.utime = sight.ball.utime;
	prediction_.track = sight.ball.track;
	prediction_.observations = sight.observations;
	fill(sight.prediction, prediction_);
	fill_path(sight.prediction, prediction_);
	send("PONGEYE_PREDICTION", prediction_, prediction_.utime);
}

void Publisher::publish(const StatusReport &report)
{
	status_.utime = unix_ns() / 1000;
	status_.pairs = report.pairs;
	status_.dropped = report.dropped;
	status_.balls = report.outcomes[PONG_SEEN];
	status_.nothing = report.outcomes[PONG_NOTHING];
	status_.one_eyed = report.outcomes[PONG_ONE_EYED];
	status_.mismatched = report.outcomes[PONG_MISMATCH];
	status_.rejected = report.outcomes[PONG_REJECTED];
	status_.missed_left = report.missed_left;
	status_.missed_right = report.missed_right;
	status_.unpaired = report.causes.unpaired + report.causes.miscounted;
	status_.incomplete = report.causes.incomplete;
	status_.late = report.causes.late;
	status_.repeated = report.causes.repeated;
	status_.camera_left = static_cast<int8_t>(report.cameras[PONG_LEFT].state);
	status_.camera_right = static_cast<int8_t>(report.cameras[PONG_RIGHT].state);
	status_.losses_left = report.cameras[PONG_LEFT].losses;
	status_.losses_right = report.cameras[PONG_RIGHT].losses;
	status_.pair_rate = report.pair_rate;
	status_.ball_rate = report.ball_rate;
	status_.latency_median = report.latency_median;
	status_.latency_p99 = report.latency_p99;
	status_.latency_max = report.latency_max;
	status_.epipolar_mean = report.epipolar_mean;
	status_.epipolar_rms = report.epipolar_rms;
	status_.rig_offset = report.rig.mean;
	status_.rig_offset_sigma = report.rig.sigma;
	status_.rig_knocked = report.rig.knocked;
	send("PONGEYE_STATUS", status_, 0);
}

} // namespace track
