#include "live_table.hpp"

#include <cmath>
#include <cstdio>
#include <string>
#include <sys/ioctl.h>
#include <unistd.h>

#include "clock.hpp"
#include "program.hpp"

namespace track
{

namespace
{

constexpr int64_t TRACKING_INTERVAL_NS = 200000000;
constexpr int64_t SEARCHING_INTERVAL_NS = 1000000000;

std::string cell(double value, int width, int decimals)
{
	return std::isfinite(value) ? pong::format("%*.*f", width, decimals, value) : pong::format("%*s", width, "-");
}

// Columns of the terminal; of a file, more than enough.
int columns()
{
	winsize size = {};
	return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 1000;
}

// Whether a row with the latencies fits.
bool wide()
{
	return columns() > 91;
}

} // namespace

Live::Live() : terminal_(isatty(STDERR_FILENO)), drawn_ns_(monotonic_ns())
{
}

Live::~Live()
{
	if (row_open_)
		fputc('\n', stderr);
}

void Live::begin_table()
{
	fprintf(stderr, "%-9s%7s%7s%7s%7s%8s%8s%7s%8s%8s", "state", "flight", "x m", "y m", "z m", "hit x m", "hit y m",
		"in ms", "pairs/s", "balls/s");
	fputs(wide() ? " latency p99 ms\n" : "\n", stderr);
	begun_ = true;
}

// A flight goes on where a pair without a ball was searched in the window that the prediction opened.
void Live::see(const pong_sight &sight)
{
	tracking_ = sight.has_ball || (was_tracking_ && sight.windowed);
	if (!sight.has_ball)
		return;
	ball_ = sight.ball;
	has_hit_ = sight.has_prediction && sight.prediction.has_hit;
	if (has_hit_)
		hit_ = sight.prediction.hit;
}

void Live::draw(const StatusReport &report, int64_t now_ns)
{
	const bool changed = tracking_ != was_tracking_;
	const int64_t interval = tracking_ || terminal_ ? TRACKING_INTERVAL_NS : SEARCHING_INTERVAL_NS;
	if (!changed && now_ns - drawn_ns_ < interval)
		return;
	if (!begun_)
		begin_table();
	const bool flight_over = changed && was_tracking_;
	if (terminal_)
		fputs(row_open_ ? "\r\033[K" : "", stderr);
	if (flight_over) {
		tracking_ = true;
		draw_row(report);
		fputc('\n', stderr);
		tracking_ = false;
	}
	if (!flight_over || terminal_) {
		draw_row(report);
		row_open_ = terminal_;
		fputs(terminal_ ? "" : "\n", stderr);
	}
	fflush(stderr);
	was_tracking_ = tracking_;
	drawn_ns_ = now_ns;
}

void Live::draw_row(const StatusReport &report) const
{
	const double nothing = NAN;
	const bool hit = tracking_ && has_hit_;
	std::string row = pong::format("%-9s", tracking_ ? "tracking" : "searching");
	row += cell(tracking_ ? ball_.track : nothing, 7, 0);
	for (const double position : ball_.position)
		row += cell(tracking_ ? position : nothing, 7, 3);
	row += cell(hit ? hit_.position[0] : nothing, 8, 3);
	row += cell(hit ? hit_.position[1] : nothing, 8, 3);
	row += cell(hit ? static_cast<double>(hit_.utime - ball_.utime) * 1e-3 : nothing, 7, 0);
	row += cell(report.pair_rate, 8, 1);
	row += cell(report.ball_rate, 8, 1);
	if (wide()) {
		row += cell(1e3 * report.latency_median, 8, 2);
		row += cell(1e3 * report.latency_p99, 7, 2);
	}
	fputs(row.c_str(), stderr);
}

} // namespace track
