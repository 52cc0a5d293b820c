// How a tracker did, against what a simulator knows: balls found, points that are none, error in space, and error of
// the predicted hit by the time that was left. Rows are matched by their times. Pairs that the tracker never got (a
// busy machine loses some) are counted, not judged.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "commands.hpp"
#include "options.hpp"
#include "owned.hpp"
#include "pongeye.h"
#include "program.hpp"
#include "table.hpp"

namespace
{

using pong::Table;

struct Truth {
	int64_t utime, hit_utime;
	bool has_ball, in_view;
	double position[3], hit[3];
	double uv[2][2];
};

struct Tracked {
	int64_t utime, hit_utime;
	bool has_ball, has_hit;
	double position[3], hit[3];
};

double distance(const double a[3], const double b[3])
{
	return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

std::vector<Truth> read_truth(const std::string &path)
{
	const Table table(path);
	const size_t utime = table.column("utime"), x = table.column("x"), y = table.column("y"), z = table.column("z");
	const size_t seen[2] = {table.column("seen_left"), table.column("seen_right")};
	const size_t uv[4] = {table.column("left_u"), table.column("left_v"), table.column("right_u"),
			      table.column("right_v")};
	const size_t hit_utime = table.column("hit_utime"), hit_x = table.column("hit_x"),
		     hit_y = table.column("hit_y"), hit_z = table.column("hit_z");
	std::vector<Truth> rows;
	for (size_t i = 0; i < table.rows(); i++) {
		Truth row = {};
		row.utime = table.get_integer(i, utime);
		row.has_ball = !std::isnan(table.get(i, x));
		row.in_view = row.has_ball && table.get(i, seen[0]) > 0 && table.get(i, seen[1]) > 0;
		row.hit_utime = std::isnan(table.get(i, hit_utime)) ? 0 : table.get_integer(i, hit_utime);
		for (int k = 0; k < 3; k++) {
			row.position[k] = table.get(i, (const size_t[]){x, y, z}[k]);
			row.hit[k] = table.get(i, (const size_t[]){hit_x, hit_y, hit_z}[k]);
		}
		for (int k = 0; k < 4; k++)
			row.uv[k / 2][k % 2] = table.get(i, uv[k]);
		rows.push_back(row);
	}
	return rows;
}

std::vector<Tracked> read_tracked(const std::string &path)
{
	const Table table(path);
	const size_t utime = table.column("utime"), x = table.column("x"), y = table.column("y"), z = table.column("z");
	const size_t hit_utime = table.column("hit_utime"), hit_x = table.column("hit_x"),
		     hit_y = table.column("hit_y"), hit_z = table.column("hit_z");
	std::vector<Tracked> rows;
	for (size_t i = 0; i < table.rows(); i++) {
		Tracked row = {};
		row.utime = table.get_integer(i, utime);
		row.has_ball = !std::isnan(table.get(i, x));
		row.has_hit = !std::isnan(table.get(i, hit_x));
		row.hit_utime = row.has_hit ? table.get_integer(i, hit_utime) : 0;
		for (int k = 0; k < 3; k++) {
			row.position[k] = table.get(i, (const size_t[]){x, y, z}[k]);
			row.hit[k] = table.get(i, (const size_t[]){hit_x, hit_y, hit_z}[k]);
		}
		rows.push_back(row);
	}
	return rows;
}

// The truth of the nearest time; NULL if none is within the tolerance.
const Truth *truth_at(const std::vector<Truth> &truth, int64_t utime, int64_t tolerance)
{
	const auto later = std::lower_bound(truth.begin(), truth.end(), utime,
					    [](const Truth &row, int64_t time) { return row.utime < time; });
	const Truth *best = nullptr;
	for (auto row = later == truth.begin() ? later : later - 1; row != truth.end() && row <= later; ++row)
		if (std::llabs(row->utime - utime) <= tolerance &&
		    (!best || std::llabs(row->utime - utime) < std::llabs(best->utime - utime)))
			best = &*row;
	return best;
}

// The region that the tracker searches, in both pictures.
class Region
{
public:
	explicit Region(const std::string &path)
	{
		pong_error error;
		pong_settings settings;
		pong_settings_defaults(PONG_BEST, &settings);
		if (pong_rig_load(path.c_str(), &rig_, &error) < 0 ||
		    pong_settings_load(path.c_str(), &settings, &error) < 0)
			throw pong::Failure(error.text);
		for (int side = 0; side < 2; side++)
			region_[side].reset(pong_region_new(&rig_, static_cast<pong_side>(side), &settings, &error));
		if (!region_[0] || !region_[1])
			throw pong::Failure(error.text);
	}

	bool contains(const Truth &truth) const
	{
		for (int side = 0; side < 2; side++) {
			const int v = static_cast<int>(std::lround(truth.uv[side][1]));
			const pong_region_row row = pong_region_get_row(region_[side].get(),
									std::clamp(v, 0, rig_.camera[side].height - 1));
			if (!(truth.uv[side][0] >= row.begin && truth.uv[side][0] < row.end))
				return false;
		}
		return truth.position[2] >= rig_.hit_z;
	}

private:
	pong_rig rig_;
	pong::OwnedRegion region_[2];
};

// A list of errors, and what is said of it.
struct Errors {
	std::vector<double> values;

	double mean() const
	{
		double sum = 0;
		for (const double value : values)
			sum += value;
		return values.empty() ? NAN : sum / static_cast<double>(values.size());
	}

	double quantile(double part)
	{
		if (values.empty())
			return NAN;
		std::sort(values.begin(), values.end());
		return values[static_cast<size_t>(part * static_cast<double>(values.size() - 1))];
	}
};

// Error of the predicted hit when so much time was left.
struct HitErrors {
	double left; // s
	Errors position, time;
};

struct Score {
	int truths = 0, pairs = 0, expected = 0, found = 0, balls = 0, not_balls = 0;
	Errors position;
	std::vector<HitErrors> hits = {{0.4, {}, {}}, {0.3, {}, {}}, {0.2, {}, {}}, {0.1, {}, {}}};
};

const double hit_slot = 0.02; // s; predictions this near to a time left count for it

void add_hit(Score &score, const Tracked &tracked, const Truth &truth)
{
	const double left = static_cast<double>(truth.hit_utime - tracked.utime) * 1e-6;
	for (HitErrors &errors : score.hits) {
		if (std::abs(left - errors.left) > hit_slot / 2)
			continue;
		errors.position.values.push_back(distance(tracked.hit, truth.hit));
		errors.time.values.push_back(std::abs(static_cast<double>(tracked.hit_utime - truth.hit_utime)) * 1e-6);
	}
}

Score make_score(const std::vector<Truth> &truths, const std::vector<Tracked> &rows, const Region &region,
		 double false_beyond, int64_t tolerance)
{
	Score score;
	score.truths = static_cast<int>(truths.size());
	for (const Tracked &row : rows) {
		const Truth *truth = truth_at(truths, row.utime, tolerance);
		if (!truth)
			continue;
		score.pairs++;
		const bool expected = truth->in_view && region.contains(*truth);
		const bool is_ball =
			row.has_ball && truth->has_ball && distance(row.position, truth->position) <= false_beyond;
		score.expected += expected;
		score.found += expected && is_ball;
		score.balls += row.has_ball;
		score.not_balls += row.has_ball && !is_ball;
		if (is_ball)
			score.position.values.push_back(distance(row.position, truth->position));
		if (is_ball && row.has_hit && truth->hit_utime)
			add_hit(score, row, *truth);
	}
	return score;
}

void print_score(Score &score)
{
	printf("pairs             %d of the simulator's %d\n", score.pairs, score.truths);
	printf("balls found       %d of %d in view and region (%.2f %%)\n", score.found, score.expected,
	       100.0 * score.found / std::max(score.expected, 1));
	printf("points not balls  %d of %d published\n", score.not_balls, score.balls);
	if (!score.position.values.empty())
		printf("3-D error         mean %.1f mm, median %.1f mm, 90 %% %.1f mm\n", 1e3 * score.position.mean(),
		       1e3 * score.position.quantile(0.5), 1e3 * score.position.quantile(0.9));
	for (HitErrors &errors : score.hits)
		if (!errors.position.values.empty())
			printf("hit, %.1f s ahead  mean %.1f cm and %.1f ms, median %.1f cm and %.1f ms, of %zu\n",
			       errors.left, 1e2 * errors.position.mean(), 1e3 * errors.time.mean(),
			       1e2 * errors.position.quantile(0.5), 1e3 * errors.time.quantile(0.5),
			       errors.position.values.size());
}

// What a working tracker reaches, with room to spare: found, false points, and the hit 0.2 s ahead.
bool did_its_job(Score &score)
{
	bool good = score.pairs > 0 && score.found >= 0.95 * score.expected && score.expected > 0 &&
		    score.not_balls * 1000 <= score.pairs;
	for (HitErrors &errors : score.hits)
		if (errors.left == 0.2)
			good = good && errors.position.quantile(0.5) < 0.20 && errors.time.quantile(0.5) < 0.040;
	return good;
}

} // namespace

int bench::score(int argc, char **argv)
{
	std::string truth, track, rig;
	double false_beyond = 0.2;
	int tolerance = 2000;
	bool judge = false;
	pong::Options options(
		"pongeye-bench score", "Score a tracker's output against a simulator's truth.",
		"  $ pongeye-bench score --truth flights/truth.txt --track track.txt --rig flights/rig.toml\n"
		"  pairs             880 of the simulator's 880\n"
		"  balls found       231 of 233 in view and region (99.14 %)\n"
		"  ...");
	options.text("--truth", "FILE", "the simulator's truth.txt", &truth);
	options.text("--track", "FILE", "what pongeye-track --output wrote", &track);
	options.text("--rig", "FILE", "the rig.toml that it used", &rig);
	options.number("--false-beyond", "METRES", "a point farther than this from the ball is none (0.2)",
		       &false_beyond, 0, 10);
	options.integer("--tolerance", "US", "rows this near in time are the same pair, microseconds (2000)",
			&tolerance, 0, 1000000);
	options.flag("--judge", "exit with 1 unless the tracker did its job: 95 % found, under 1 false in 1000",
		     &judge);
	if (!options.parse(argc, argv))
		return 0;
	if (truth.empty() || track.empty() || rig.empty())
		throw pong::UsageError("score needs --truth, --track and --rig");
	Score score = make_score(read_truth(truth), read_tracked(track), Region(rig), false_beyond, tolerance);
	print_score(score);
	return judge && !did_its_job(score) ? 1 : 0;
}
