// An LCM subscriber that knows nothing of the tracker but its message types: counts what it hears for some seconds,
// or until SIGTERM, looks at every value, and prints `name count` lines.
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <lcm/lcm-cpp.hpp>

#include "pongeye/ball_t.hpp"
#include "pongeye/prediction_t.hpp"
#include "pongeye/status_t.hpp"

namespace
{

struct Heard {
	int balls = 0, predictions = 0, statuses = 0, insane = 0;
	int64_t missed_left = 0, missed_right = 0; // by the last status
	int64_t last_ball = 0, last_frame = 0;
};

int64_t now_utime()
{
	using namespace std::chrono;
	return duration_cast<microseconds>(system_clock::now().time_since_epoch()).count();
}

class Listener
{
public:
	void on_ball(const lcm::ReceiveBuffer *, const std::string &, const pongeye::ball_t *ball)
	{
		heard.balls++;
		const bool over_the_table = std::abs(ball->position[0]) < 1.5 && ball->position[1] > -0.1 &&
					    ball->position[1] < 1.5 && ball->position[2] > -0.5 &&
					    ball->position[2] < 5;
		const bool in_the_pictures = ball->left[0] > 0 && ball->left[0] < 640 && ball->right[1] > 0 &&
					     ball->right[1] < 480 && ball->radius > 2 && ball->radius < 60;
		const bool later = ball->utime > heard.last_ball && ball->frame > heard.last_frame;
		const int64_t delay = now_utime() - ball->utime;
		const bool just_now = delay > 0 && delay < 2000000; // generous: the machine may be busy
		heard.insane += !(over_the_table && in_the_pictures && later && just_now && ball->covariance[2][2] > 0);
		heard.last_ball = ball->utime;
		heard.last_frame = ball->frame;
	}

	void on_prediction(const lcm::ReceiveBuffer *, const std::string &, const pongeye::prediction_t *prediction)
	{
		heard.predictions++;
		if (prediction->has_hit)
			heard.insane += !(std::abs(prediction->hit_position[2]) < 1e-3 &&
					  prediction->hit_utime > prediction->utime && prediction->path_count > 0);
	}

	void on_status(const lcm::ReceiveBuffer *, const std::string &, const pongeye::status_t *status)
	{
		heard.statuses++;
		heard.insane += !(status->pairs >= status->balls);
		heard.missed_left = status->missed_left;
		heard.missed_right = status->missed_right;
	}

	Heard heard;
};

} // namespace

volatile std::sig_atomic_t stop = 0;

int main(int argc, char **argv)
{
	const double seconds = argc > 1 ? atof(argv[1]) : 5;
	lcm::LCM lcm;
	if (!lcm.good())
		return 1;
	Listener listener;
	lcm.subscribe("PONGEYE_BALL", &Listener::on_ball, &listener);
	lcm.subscribe("PONGEYE_PREDICTION", &Listener::on_prediction, &listener);
	lcm.subscribe("PONGEYE_STATUS", &Listener::on_status, &listener);
	const int64_t end = now_utime() + static_cast<int64_t>(seconds * 1e6);
	std::signal(SIGTERM, [](int) { stop = 1; });
	while (!stop && now_utime() < end)
		lcm.handleTimeout(100);
	printf("balls %d\npredictions %d\nstatuses %d\ninsane %d\n", listener.heard.balls, listener.heard.predictions,
	       listener.heard.statuses, listener.heard.insane);
	printf("missed_left %lld\nmissed_right %lld\n", static_cast<long long>(listener.heard.missed_left),
	       static_cast<long long>(listener.heard.missed_right));
	return 0;
}
