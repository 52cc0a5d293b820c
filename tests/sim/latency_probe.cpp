// How long pictures take from their last packet to a message on the wire, and to the callback of a client that does
// nothing else. The kernel's time of each packet on the loopback interface tells, so nothing that is measured knows of
// it; it takes the right to open a packet socket, which root of a network namespace has.
//
//     latency_probe SECONDS                       listens while a tracker runs; prints rows `what count median p99
//     max`, us latency_probe SECONDS ADDRESS ADDRESS       is that client itself, of the cameras at these addresses
#include <algorithm>
#include <arpa/inet.h>
#include <arv.h>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <linux/filter.h>
#include <linux/if_packet.h>
#include <map>
#include <mutex>
#include <net/ethernet.h>
#include <poll.h>
#include <string>
#include <sys/socket.h>
#include <unistd.h>
#include <vector>

#include "program.hpp"
#include "realtime.hpp"

namespace
{

constexpr int UDP = 20, PAYLOAD = 28; // offsets in a packet without IP options
constexpr int LCM_PORT = 7667, GVCP_PORT = 3956, GVSP_TRAILER = 2;
constexpr uint32_t LCM_SHORT = 0x4c433032, LCM_FRAGMENT = 0x4c433033; // "LC02", "LC03"

struct Sight {
	int64_t time_us; // when the message left
	int64_t utime;   // of the pair
	int32_t track;
};

std::map<uint32_t, std::vector<int64_t>> trailers; // by camera: when the last packet of each picture left, us
std::vector<Sight> balls;
std::vector<int64_t> predictions; // the last fragment of each, us
std::mutex mutex;                 // guards arrivals
std::vector<int64_t> arrivals;    // callbacks, us

uint32_t load32(const uint8_t *bytes)
{
	return uint32_t{bytes[0]} << 24 | uint32_t{bytes[1]} << 16 | uint32_t{bytes[2]} << 8 | bytes[3];
}

int64_t load64(const uint8_t *bytes)
{
	return static_cast<int64_t>(uint64_t{load32(bytes)} << 32 | load32(bytes + 4));
}

// Only LCM's packets and the last ones of pictures: the rest would wake us thousands of times a second.
int open_wire()
{
	sock_filter program[] = {
		BPF_STMT(BPF_LD | BPF_H | BPF_ABS, UDP + 2),
		BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, LCM_PORT, 5, 0),
		BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, GVCP_PORT, 5, 0),
		BPF_STMT(BPF_LD | BPF_H | BPF_ABS, UDP),
		BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, GVCP_PORT, 3, 0),
		BPF_STMT(BPF_LD | BPF_B | BPF_ABS, PAYLOAD + 4),
		BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, GVSP_TRAILER, 0, 1),
		BPF_STMT(BPF_RET | BPF_K, 65536),
		BPF_STMT(BPF_RET | BPF_K, 0),
	};
	const sock_fprog filter = {sizeof program / sizeof *program, program};
	const int yes = 1;
	const int wire = socket(AF_PACKET, SOCK_DGRAM, htons(ETH_P_IP));
	if (wire < 0 || setsockopt(wire, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter) != 0 ||
	    setsockopt(wire, SOL_SOCKET, SO_TIMESTAMPNS, &yes, sizeof yes) != 0)
		throw pong::Failure("cannot listen to the loopback interface's packets: that takes CAP_NET_RAW");
	return wire;
}

void see_message(int64_t time, const uint8_t *bytes, size_t size)
{
	const uint32_t magic = load32(bytes);
	const char *channel = reinterpret_cast<const char *>(bytes) + 8;
	if (magic == LCM_SHORT && size > 60 && strcmp(channel, "PONGEYE_BALL") == 0) {
		const uint8_t *ball = bytes + 8 + sizeof "PONGEYE_BALL" + 8; // behind the type's hash
		balls.push_back({time, load64(ball), static_cast<int32_t>(load32(ball + 16))});
	} else if (magic == LCM_FRAGMENT || (magic == LCM_SHORT && strcmp(channel, "PONGEYE_PREDICTION") == 0)) {
		predictions.push_back(time);
	}
}

void read_packet(int wire)
{
	uint8_t bytes[2048] = {};
	char control[256];
	sockaddr_ll from = {};
	iovec part = {bytes, sizeof bytes - 1};
	msghdr message = {&from, sizeof from, &part, 1, control, sizeof control, 0};
	const ssize_t size = recvmsg(wire, &message, 0);
	if (size <= PAYLOAD || from.sll_pkttype == PACKET_OUTGOING) // each comes by twice
		return;
	int64_t time = 0;
	for (cmsghdr *item = CMSG_FIRSTHDR(&message); item; item = CMSG_NXTHDR(&message, item))
		if (item->cmsg_level == SOL_SOCKET && item->cmsg_type == SCM_TIMESTAMPNS) {
			timespec stamp;
			memcpy(&stamp, CMSG_DATA(item), sizeof stamp);
			time = stamp.tv_sec * INT64_C(1000000) + stamp.tv_nsec / 1000;
		}
	if ((bytes[UDP + 2] << 8 | bytes[UDP + 3]) == LCM_PORT)
		see_message(time, bytes + PAYLOAD, static_cast<size_t>(size) - PAYLOAD);
	else
		trailers[load32(bytes + 12)].push_back(time);
}

void listen(int wire, double seconds)
{
	const int64_t end = g_get_monotonic_time() + std::llround(seconds * 1e6);
	pollfd input = {wire, POLLIN, 0};
	while (g_get_monotonic_time() < end && !pong::stop_requested())
		if (poll(&input, 1, 100) > 0)
			read_packet(wire);
}

void report(const char *what, std::vector<int64_t> times)
{
	if (times.empty())
		return;
	std::sort(times.begin(), times.end());
	const auto at = [&](double part) {
		return times[static_cast<size_t>(part * static_cast<double>(times.size() - 1))];
	};
	printf("%s %zu %lld %lld %lld\n", what, times.size(), static_cast<long long>(at(0.5)),
	       static_cast<long long>(at(0.99)), static_cast<long long>(times.back()));
}

// The last one at or before a time; 0: none.
int64_t latest(const std::vector<int64_t> &times, int64_t time)
{
	const auto after = std::upper_bound(times.begin(), times.end(), time);
	return after == times.begin() ? 0 : after[-1];
}

// Of a pair's pictures, the later one's last packet. A picture's last packet leaves a fixed time after its exposure, so
// of one camera's the one nearest to that is the pair's, however late the message is.
int64_t last_packet(const Sight &ball, int64_t delay)
{
	int64_t last = 0;
	for (const auto &[camera, times] : trailers)
		last = std::max(last, latest(times, ball.utime + delay + 4500));
	return last;
}

void report_tracker()
{
	std::vector<int64_t> delays, windowed, searching, predicted;
	for (const Sight &ball : balls)
		for (const auto &[camera, times] : trailers)
			if (const int64_t last = latest(times, ball.time_us))
				delays.push_back(last - ball.utime);
	if (delays.empty())
		throw pong::Failure("no ball was published");
	std::nth_element(delays.begin(), delays.begin() + static_cast<std::ptrdiff_t>(delays.size() / 2), delays.end());
	const int64_t delay = delays[delays.size() / 2];
	std::map<int32_t, int> count; // of a flight
	for (const Sight &ball : balls) {
		// Two points tell a velocity: from the third on there is a window.
		auto &list = ++count[ball.track] <= 2 ? searching : windowed;
		list.push_back(ball.time_us - last_packet(ball, delay));
		const auto prediction = std::lower_bound(predictions.begin(), predictions.end(), ball.time_us);
		if (prediction != predictions.end() && *prediction < ball.time_us + 2000)
			predicted.push_back(*prediction - last_packet(ball, delay));
	}
	report("ball_windowed", windowed);
	report("ball_searching", searching);
	report("prediction", predicted);
}

// A client of one camera that only takes its pictures.
class Client
{
public:
	explicit Client(const char *address) : camera_(arv_camera_new(address, nullptr))
	{
		if (!camera_)
			throw pong::Failure(std::string(address) + ": no camera there");
		arv_camera_set_trigger(camera_, "Line1", nullptr);
		arv_camera_gv_set_stream_options(camera_, ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
		arv_camera_gv_auto_packet_size(camera_, nullptr);
		stream_ = arv_camera_create_stream(camera_, on_stream, this, nullptr);
		g_object_set(stream_, "socket-buffer", ARV_GV_STREAM_SOCKET_BUFFER_FIXED, "socket-buffer-size", 4 << 20,
			     nullptr);
		const guint payload = arv_camera_get_payload(camera_, nullptr);
		for (int i = 0; i < 64; i++)
			arv_stream_push_buffer(stream_, arv_buffer_new_allocate(payload));
		arv_camera_start_acquisition(camera_, nullptr);
	}

	~Client()
	{
		arv_camera_stop_acquisition(camera_, nullptr);
		g_object_unref(stream_);
		g_object_unref(camera_);
	}

private:
	static void on_stream(void *client, ArvStreamCallbackType event, ArvBuffer *)
	{
		if (event == ARV_STREAM_CALLBACK_TYPE_INIT)
			track::make_thread_realtime(10);
		if (event != ARV_STREAM_CALLBACK_TYPE_BUFFER_DONE)
			return;
		const int64_t now = g_get_real_time();
		ArvStream *stream = static_cast<Client *>(client)->stream_;
		if (ArvBuffer *buffer = arv_stream_pop_buffer(stream))
			arv_stream_push_buffer(stream, buffer);
		const std::lock_guard<std::mutex> lock(mutex);
		arrivals.push_back(now);
	}

	ArvCamera *camera_;
	ArvStream *stream_ = nullptr;
};

// Whose picture a callback is for does not matter: the packet before it is its own, but where both come at once.
void report_client()
{
	std::vector<int64_t> all, times;
	for (const auto &[camera, list] : trailers)
		all.insert(all.end(), list.begin(), list.end());
	std::sort(all.begin(), all.end());
	std::sort(arrivals.begin(), arrivals.end());
	// The n-th callback after a silence belongs to the n-th packet after it.
	size_t packet = 0;
	for (size_t i = 0; i < arrivals.size(); i++) {
		while (packet < all.size() && all[packet] < arrivals[i] - 5000)
			packet++;
		if (packet < all.size() && all[packet] <= arrivals[i])
			times.push_back(arrivals[i] - all[packet++]);
	}
	report("callback", times);
}

int probe(int argc, char **argv)
{
	if (argc != 2 && argc != 4)
		throw pong::UsageError("SECONDS [ADDRESS ADDRESS]");
	const int wire = open_wire();
	if (argc == 2) {
		listen(wire, atof(argv[1]));
		report_tracker();
		return 0;
	}
	{
		const Client left(argv[2]), right(argv[3]);
		listen(wire, atof(argv[1]));
	}
	report_client();
	return 0;
}

} // namespace

int main(int argc, char **argv)
{
	return pong::run_program("latency_probe", argc, argv, probe);
}
