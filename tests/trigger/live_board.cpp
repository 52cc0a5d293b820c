// The board, emulated in real time: plugged into a USB that a program, started by this one, finds under umockdev, and
// wired to pongeye-simulate's trigger line.
//
//     umockdev-wrapper live_board FIRMWARE.elf SOCKET PROGRAM ARGUMENT ...
//
// Ends when the program ends, with its status; says how it went on stdout.
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <glib.h>
#include <mutex>
#include <stdexcept>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "board.hpp"
#include "child.hpp"
#include "usbfs.hpp"

namespace
{

constexpr int64_t SECOND_NS = 1000000000;

int64_t monotonic_ns()
{
	timespec now;
	clock_gettime(CLOCK_MONOTONIC, &now);
	return now.tv_sec * SECOND_NS + now.tv_nsec;
}

void sleep_until(int64_t time_ns)
{
	const timespec until = {time_ns / SECOND_NS, time_ns % SECOND_NS};
	while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr))
		continue; // a signal
}

// The wire to the cameras.
class Wire
{
public:
	explicit Wire(const std::string &path) : descriptor_(socket(AF_UNIX, SOCK_DGRAM, 0))
	{
		sockaddr_un address = {};
		address.sun_family = AF_UNIX;
		if (path.size() >= sizeof address.sun_path)
			throw std::runtime_error(path + ": too long");
		memcpy(address.sun_path, path.c_str(), path.size());
		if (connect(descriptor_, reinterpret_cast<sockaddr *>(&address), sizeof address))
			throw std::runtime_error(path + ": " + strerror(errno));
	}

	~Wire()
	{
		close(descriptor_);
	}

	Wire(const Wire &) = delete;
	Wire &operator=(const Wire &) = delete;

	void rise(int64_t time_ns) const
	{
		if (send(descriptor_, &time_ns, sizeof time_ns, 0) != sizeof time_ns)
			throw std::runtime_error(std::string("the trigger line is cut: ") + strerror(errno));
	}

private:
	int descriptor_;
};

// Lets the board's time pass as the host's does. umockdev answers requests in a thread of its own: the board is that
// one's from before a request until after it.
class Pacer
{
public:
	Pacer(Board *board, const Wire *wire)
		: board_(board), wire_(wire), begin_cycle_(board->cycle()), begin_ns_(monotonic_ns())
	{
	}

	// While nobody asks.
	void tick()
	{
		const std::lock_guard<std::mutex> lock(mutex_);
		catch_up();
	}

	void begin_request()
	{
		mutex_.lock();
		catch_up();
	}

	// The board is ahead of the host then.
	void end_request()
	{
		carry_edges();
		const int64_t until = host_ns(board_->cycle());
		mutex_.unlock();
		sleep_until(until);
	}

	int edges() const
	{
		return edges_;
	}

	double most_behind() const
	{
		return static_cast<double>(most_behind_) * 1e-9;
	}

private:
	void catch_up()
	{
		const int64_t behind = monotonic_ns() - host_ns(board_->cycle());
		if (behind <= 0)
			return;
		most_behind_ = std::max(most_behind_, behind);
		board_->run(static_cast<uint64_t>(static_cast<double>(behind) * 1e-9 * Board::FREQUENCY));
		carry_edges();
	}

	int64_t host_ns(uint64_t cycle) const
	{
		return begin_ns_ +
		       std::llround(static_cast<double>(cycle - begin_cycle_) / Board::FREQUENCY * SECOND_NS);
	}

	void carry_edges()
	{
		for (const Edge &edge : board_->edges(LEFT))
			if (edge.level) {
				wire_->rise(host_ns(edge.cycle));
				edges_++;
			}
		board_->forget_edges();
	}

	std::mutex mutex_;
	Board *board_;
	const Wire *wire_;
	uint64_t begin_cycle_;
	int64_t begin_ns_, most_behind_ = 0;
	int edges_ = 0;
};

int on_tick(gpointer pacer)
{
	static_cast<Pacer *>(pacer)->tick();
	return G_SOURCE_CONTINUE;
}

[[noreturn]] void run(int argc, char **argv)
{
	UMockdevTestbed *testbed = umockdev_testbed_new();
	if (argc < 4 || !umockdev_in_mock_environment())
		throw std::runtime_error("umockdev-wrapper live_board FIRMWARE.elf SOCKET PROGRAM ARGUMENT ...");
	Board board(argv[1]);
	const Wire wire(argv[2]);
	Usbfs usbfs(&board, testbed);
	board.forget_edges();
	Pacer pacer(&board, &wire);
	usbfs.on_request = [&pacer] { pacer.begin_request(); };
	usbfs.on_time = [&pacer] { pacer.end_request(); };
	g_timeout_add(1, on_tick, &pacer);

	Child child(std::vector<std::string>(argv + 3, argv + argc), {});
	const Outcome outcome = child.finish();
	fputs(outcome.err.c_str(), stderr);
	printf("status %d\nedges %d\nmost_behind_ms %.1f\n", outcome.status, pacer.edges(), pacer.most_behind() * 1e3);
	g_object_unref(testbed);
	fflush(nullptr);
	// umockdev's thread may still answer a request of the program that has just ended: nothing that it uses may go
	// before the process does.
	_exit(outcome.status == 0 ? 0 : 1);
}

} // namespace

int main(int argc, char **argv)
{
	try {
		run(argc, argv);
	} catch (const std::exception &error) {
		fprintf(stderr, "live_board: %s\n", error.what());
		return 1;
	}
}
