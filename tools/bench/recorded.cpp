#include "recorded.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include <Eigen/Core>

#include "predict/fit.hpp"
#include "predict/follow.hpp"
#include "program.hpp"

namespace bench
{

namespace
{

const double first_cut = 0.12, between_cuts = 0.08; // s
const double ahead[] = {0.1, 0.2, 0.3, 0.4};        // s
const double longest_gap = 0.02;                    // s; across a longer one there is no truth

double seconds(int64_t from, int64_t to)
{
	return static_cast<double>(to - from) * 1e-6;
}

// The measured position at a time, on the line between its neighbours. False where the recording has none.
bool truth_at(const predict::RecordedFlight &flight, int64_t utime, Eigen::Vector3d *position)
{
	const auto after = std::lower_bound(flight.points.begin(), flight.points.end(), utime,
					    [](const pong_point &point, int64_t t) { return point.utime < t; });
	if (after == flight.points.begin() || after == flight.points.end() ||
	    seconds(after[-1].utime, after->utime) > longest_gap)
		return false;
	const Eigen::Map<const Eigen::Vector3d> a(after[-1].position), b(after->position);
	const double part = seconds(after[-1].utime, utime) / seconds(after[-1].utime, after->utime);
	*position = (1 - part) * a + part * b;
	return true;
}

// Errors by class, profile and time ahead, m.
struct Errors {
	std::map<std::string, std::vector<double>> of[2][4];
};

void predict_flight(const predict::RecordedFlight &flight, const pong_rig &rig, pong_profile profile, Errors &errors)
{
	pong_settings settings;
	pong_settings_defaults(profile, &settings);
	predict::Follower follower(rig, settings);
	const std::string kind = flight.name.substr(0, flight.name.rfind('-'));
	double cut = first_cut;
	for (size_t i = 0; i + 1 < flight.points.size(); i++) {
		const pong_point &point = flight.points[i];
		follower.push(point, 0);
		if (seconds(flight.points[0].utime, flight.points[i + 1].utime) <= cut)
			continue;
		cut += between_cuts;
		for (int k = 0; k < 4; k++) {
			const int64_t utime = point.utime + std::llround(1e6 * ahead[k]);
			Eigen::Vector3d truth;
			pong_state expected;
			if (!truth_at(flight, utime, &truth))
				continue;
			const bool known = follower.expect(utime, &expected);
			const Eigen::Map<const Eigen::Vector3d> position(expected.position);
			errors.of[profile][k][kind].push_back(known ? (position - truth).norm() : INFINITY);
		}
	}
}

double quantile(std::vector<double> values, double part)
{
	std::sort(values.begin(), values.end());
	return values.empty() ? NAN : values[static_cast<size_t>(part * static_cast<double>(values.size() - 1) + 0.5)];
}

void print_errors(const Errors &errors)
{
	printf("# class ahead_s predictions ours_median_cm ours_90_cm paper_median_cm paper_90_cm\n");
	for (int k = 0; k < 4; k++) {
		std::vector<double> all[2];
		for (const auto &[kind, ours] : errors.of[PONG_BEST][k]) {
			const auto &paper = errors.of[PONG_PAPER][k].at(kind);
			printf("%s %.1f %zu %.2f %.2f %.2f %.2f\n", kind.c_str(), ahead[k], ours.size(),
			       100 * quantile(ours, 0.5), 100 * quantile(ours, 0.9), 100 * quantile(paper, 0.5),
			       100 * quantile(paper, 0.9));
			all[PONG_BEST].insert(all[PONG_BEST].end(), ours.begin(), ours.end());
			all[PONG_PAPER].insert(all[PONG_PAPER].end(), paper.begin(), paper.end());
		}
		printf("all %.1f %zu %.2f %.2f %.2f %.2f\n", ahead[k], all[PONG_BEST].size(),
		       100 * quantile(all[PONG_BEST], 0.5), 100 * quantile(all[PONG_BEST], 0.9),
		       100 * quantile(all[PONG_PAPER], 0.5), 100 * quantile(all[PONG_PAPER], 0.9));
	}
}

} // namespace

void score_recorded(const std::string &path, int folds)
{
	const auto flights = predict::read_flights(path);
	pong_settings settings;
	pong_settings_defaults(PONG_BEST, &settings);
	Errors errors;
	const size_t parts = static_cast<size_t>(std::max(folds, 1));
	for (size_t part = 0; part < parts && !pong::stop_requested(); part++) {
		pong_rig rig;
		pong_rig_defaults(&rig);
		std::vector<predict::RecordedFlight> others;
		for (size_t i = 0; i < flights.size(); i++)
			if (i % parts != part)
				others.push_back(flights[i]);
		if (folds > 0)
			predict::fit(others, settings, 0, rig);
		for (size_t i = part; i < flights.size(); i += parts)
			for (const pong_profile profile : {PONG_PAPER, PONG_BEST})
				predict_flight(flights[i], rig, profile, errors);
	}
	print_errors(errors);
}

} // namespace bench
