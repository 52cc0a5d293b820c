// How long the eye takes, beside OpenCV's way and beside what merely reading the pixels takes: one thread, on a ring of
// frames that no cache holds. In life the current picture has just arrived, and the cache holds it, but not the earlier
// ones, 8 and 16 pictures old: windows are timed so too, and with all three in the cache.
#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <functional>

#include "commands.hpp"
#include "opencv_way.hpp"
#include "options.hpp"
#include "owned.hpp"
#include "program.hpp"
#include "studio.hpp"

namespace
{

using namespace bench;

// A ball flies through the ring: shot after shot, each with its own copy of every picture.
struct Ring {
	std::vector<Shot> shots;
	std::vector<Eigen::Vector3d> places;
	Eigen::Vector3d velocity = {0.3, -0.5, -8};

	Ring(Studio &studio, int length)
	{
		for (int i = 0; i < length; i++) {
			const double part = static_cast<double>(i) / length;
			const Eigen::Vector3d place(0.1 - 0.2 * part, 0.30, 2.3 - 1.2 * part);
			Shot shot;
			if (studio.take(place, velocity, &shot)) {
				shots.push_back(shot);
				places.push_back(place);
			}
		}
	}
};

// Times of one thing, us.
class Stopwatch
{
public:
	void time(const std::function<void()> &what)
	{
		const auto begin = std::chrono::steady_clock::now();
		what();
		times_.push_back(
			std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count());
	}

	void print(const char *name)
	{
		std::sort(times_.begin(), times_.end());
		printf("%-34s %8.1f %8.1f\n", name, times_[times_.size() / 2], times_[times_.size() * 99 / 100]);
	}

private:
	std::vector<double> times_;
};

// Reads every pixel, eight at a time: what is left then is the memory's time.
uint64_t read_pixels(const std::vector<uint8_t> &pixels)
{
	uint64_t sum = 0, word;
	for (size_t i = 0; i + sizeof word <= pixels.size(); i += sizeof word) {
		memcpy(&word, &pixels[i], sizeof word);
		sum ^= word;
	}
	return sum;
}

struct Eyes {
	pong_settings settings;
	pong::OwnedRegion region[2]; // outlive the detectors
	pong::OwnedDetector detector[2];

	explicit Eyes(const pong_rig &rig)
	{
		pong_settings_defaults(PONG_BEST, &settings);
		for (int side = 0; side < 2; side++) {
			region[side].reset(pong_region_new(&rig, static_cast<pong_side>(side), &settings, nullptr));
			detector[side].reset(pong_detector_new(region[side].get(), &settings, nullptr));
		}
	}
};

// The same, of the pixels of a window.
uint64_t read_window(const pong_image &image, const pong_window &window)
{
	uint64_t sum = 0, word;
	const int u_end = std::min(window.u + window.width, image.width);
	const int v_end = std::min(window.v + window.height, image.height);
	for (int v = std::max(window.v, 0); v < v_end; v++)
		for (int u = std::max(window.u, 0); u + static_cast<int>(sizeof word) <= u_end; u += sizeof word) {
			memcpy(&word, image.pixels + v * image.stride + u, sizeof word);
			sum ^= word;
		}
	return sum;
}

// One byte of each cache line of a window: nothing that looks at all of it is quicker.
uint64_t touch_window(const pong_image &image, const pong_window &window)
{
	const uintptr_t cache_line = 64; // bytes
	uint64_t sum = 0;
	const int u_begin = std::max(window.u, 0), u_end = std::min(window.u + window.width, image.width);
	const int v_end = std::min(window.v + window.height, image.height);
	for (int v = std::max(window.v, 0); v < v_end; v++) {
		const uint8_t *const row = image.pixels + v * image.stride, *const end = row + u_end;
		const uint8_t *at = row + u_begin;
		for (; at < end; at += cache_line - reinterpret_cast<uintptr_t>(at) % cache_line)
			sum += *at;
	}
	return sum;
}

class Race
{
public:
	// Of earlier pictures the detectors remember what the eye has them remember.
	Race(Studio &studio, int length) : studio_(studio), ring_(studio, length), eyes_(studio.rig())
	{
		for (const Shot &shot : ring_.shots)
			for (int side = 0; side < 2; side++) {
				const pong_pictures pictures = shot.pictures(static_cast<pong_side>(side));
				for (const pong_image &earlier : pictures.earlier)
					pong_detector_remember(eyes_.detector[side].get(), &earlier);
			}
		for (const Eigen::Vector3d &place : ring_.places) {
			windows_.emplace_back();
			for (int side = 0; side < 2; side++)
				pong_window_around(&studio_.rig(), static_cast<pong_side>(side), place.data(),
						   &eyes_.settings, &windows_.back()[static_cast<size_t>(side)]);
		}
	}

	size_t length() const
	{
		return ring_.shots.size();
	}

	void read(size_t i, size_t pictures)
	{
		for (const auto &side : ring_.shots[i].pixels)
			for (size_t k = 0; k < pictures; k++)
				sink_ = sink_ + read_pixels(side[k]);
	}

	// What a search in windows reads, of all three pictures.
	void read_windows(size_t i)
	{
		for_each_window(i, [&](const pong_image &image, const pong_window &window) {
			sink_ = sink_ + read_window(image, window);
		});
	}

	void touch_windows(size_t i)
	{
		for_each_window(i, [&](const pong_image &image, const pong_window &window) {
			sink_ = sink_ + touch_window(image, window);
		});
	}

	// Whole pictures, or windows of what the eye would make of a prediction.
	void detect(size_t i, bool windowed)
	{
		for (size_t side = 0; side < 2; side++) {
			const pong_pictures pictures = ring_.shots[i].pictures(static_cast<pong_side>(side));
			found_[side] =
				pong_detect(eyes_.detector[side].get(), &pictures,
					    windowed ? &windows_[i][side] : nullptr, detections_[side], capacity);
		}
	}

	// Whether the ball was found by the last detect, in both pictures.
	bool found(size_t i) const
	{
		bool both = true;
		for (int side = 0; side < 2; side++) {
			bool one = false;
			for (int k = 0; k < found_[side]; k++)
				one |= std::hypot(detections_[side][k].u - ring_.shots[i].uv[side][0],
						  detections_[side][k].v - ring_.shots[i].uv[side][1]) < 4;
			both &= one;
		}
		return both;
	}

	void locate(size_t i, pong_locate_method method)
	{
		eyes_.settings.locate.method = method;
		pong_centre centre[2];
		pong_point point;
		double streak[3];
		for (int side = 0; side < 2; side++) {
			const pong_pictures pictures = ring_.shots[i].pictures(static_cast<pong_side>(side));
			const pong_camera &camera = studio_.rig().camera[side];
			pong_streak(&camera, ring_.places[i].data(), ring_.velocity.data(), 0.002, streak);
			if (!found_[side] || !pong_locate(&camera, &pictures, &detections_[side][0], streak,
							  &eyes_.settings, &centre[side]))
				return;
		}
		sink_ = sink_ + static_cast<uint64_t>(pong_reconstruct(&studio_.rig(), &centre[0], &centre[1],
								       &eyes_.settings, &point));
	}

	void opencv(size_t i, bool windowed)
	{
		double uv[2][2], position[3];
		for (int side = 0; side < 2; side++) {
			const Shot &shot = ring_.shots[i];
			const int half = 48;
			const cv::Rect picture(0, 0, shot.width, shot.height);
			const cv::Rect window(static_cast<int>(shot.uv[side][0]) - half,
					      static_cast<int>(shot.uv[side][1]) - half, 2 * half, 2 * half);
			if (!find_by_contour(shot.pictures(static_cast<pong_side>(side)),
					     windowed ? window & picture : picture, Rival::enclosing_circle, uv[side]))
				return;
		}
		triangulate_by_opencv(studio_.rig(), uv[0], uv[1], position);
		sink_ = sink_ + static_cast<uint64_t>(position[2] > 0);
	}

private:
	// Of all three pictures of both cameras.
	template<class Visit> void for_each_window(size_t i, Visit visit) const
	{
		for (size_t side = 0; side < 2; side++) {
			const pong_pictures pictures = ring_.shots[i].pictures(static_cast<pong_side>(side));
			for (const pong_image &image : {pictures.current, pictures.earlier[0], pictures.earlier[1]})
				visit(image, windows_[i][side]);
		}
	}

	static const int capacity = 16;
	Studio &studio_;
	Ring ring_;
	Eyes eyes_;
	std::vector<std::array<pong_window, 2>> windows_; // by side, of each shot
	pong_detection detections_[2][capacity];
	int found_[2] = {0, 0};
	volatile uint64_t sink_ = 0; // so that nothing is left out for being unused
};

// By what it is of, in the order of the table.
struct Times {
	Stopwatch read, whole, rival, window, window_arrived, window_cached, window_read, window_touched,
		window_touched_arrived, rival_window, edges, photometric;

	void print()
	{
		printf("# what median_us p99_us\n");
		read.print("read_two_frames_of_a_pair");
		whole.print("detect_whole_pair");
		rival.print("opencv_whole_pair");
		window.print("detect_windows_pair");
		window_arrived.print("detect_windows_pair_just_arrived");
		window_cached.print("detect_windows_pair_in_cache");
		window_read.print("read_three_windows_of_a_pair");
		window_touched.print("touch_three_windows_of_a_pair");
		window_touched_arrived.print("touch_three_windows_just_arrived");
		rival_window.print("opencv_windows_pair");
		edges.print("locate_edges_and_point_pair");
		photometric.print("locate_photometric_and_point_pair");
	}
};

void run_race(Race &race, int rounds)
{
	Times times;
	size_t pairs = 0, whole_found = 0, window_found = 0;
	for (int round = 0; round < rounds && !pong::stop_requested(); round++)
		for (size_t i = 0; i < race.length(); i++, pairs++) {
			// What is timed first finds the pictures out of the cache; far apart, so do the others.
			const size_t n = race.length();
			const auto far = [&](size_t ninths) { return (i + ninths * n / 9) % n; };
			const auto arrive = [&](size_t k) { race.read(k, 1); };
			times.read.time([&] { race.read(far(0), 2); });
			times.rival.time([&] { race.opencv(far(1), false); });
			times.rival_window.time([&] { race.opencv(far(2), true); });
			times.whole.time([&] { race.detect(far(3), false); });
			whole_found += race.found(far(3));
			times.window_read.time([&] { race.read_windows(far(4)); });
			times.window_touched.time([&] { race.touch_windows(far(5)); });
			arrive(far(6));
			times.window_touched_arrived.time([&] { race.touch_windows(far(6)); });
			arrive(far(7));
			times.window_arrived.time([&] { race.detect(far(7), true); });
			times.window.time([&] { race.detect(far(8), true); });
			window_found += race.found(far(8));
			times.window_cached.time([&] { race.detect(far(8), true); });
			times.edges.time([&] { race.locate(far(8), PONG_LOCATE_EDGES); });
			times.photometric.time([&] { race.locate(far(8), PONG_LOCATE_PHOTOMETRIC); });
		}
	times.print();
	pong::say(pong::format("the ball was found in %zu and, by windows, %zu of %zu pairs", whole_found, window_found,
			       pairs));
}

} // namespace

int bench::speed(int argc, char **argv)
{
	int length = 90, rounds = 10;
	pong::Options options("pongeye-bench speed",
			      "Time detection and location, one thread, beside OpenCV's way and reading the pixels.",
			      "  $ pongeye-bench speed\n");
	options.integer("--pairs", "N", "stereo pairs in the ring, each of six pictures (90)", &length, 5, 1000);
	options.integer("--rounds", "N", "rounds through the ring (10)", &rounds, 1, 100000);
	if (!options.parse(argc, argv))
		return 0;
	cv::setNumThreads(1);
	sim::Scene scene;
	Studio studio(scene, 1);
	Race race(studio, length);
	run_race(race, rounds);
	return 0;
}
