// A knocked camera put right by the balls it saw since. Its rotation is what a knock changes first: 0.05 degrees are
// 0.9 px, a shift of the camera by as much as 0.1 mm is 0.05 px at 2 m. Two things are known of every flight: the rays
// of both cameras meet (one equation a pair: the signed distance from the epipolar line), and where a ball bounces it
// touches the table (one equation a bounce: its height is its radius). The first fixes the rotation across and about
// the optical axis; the second the one that moves depth, to which epipolar lines are blind.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "calibrate_model.hpp"
#include "error.hpp"

namespace pong
{

namespace
{

const double pixel_sigma = 0.3;      // of an epipolar distance, px
const double alike = 4;              // a flight counts as so many sightings: its centres err alike, shaded alike
const double bounce_sigma = 0.0015;  // of a bounce's height as found by extrapolation, m
const double rotation_sigma = 0.002; // of a knock before anything is known: 0.11 degrees, rad
const double loss = 3;               // Huber's threshold, in sigma
const int around = 5;                // sightings on each side of a bounce that are looked at
const double step = 1e-6;            // for derivatives, rad

struct Miss {
	double value, sigma;
};

// Height over time on one side of a bounce: a line plus gravity, h = a + b t - g t^2 / 2, by least squares.
struct Branch {
	double a, b;
	double height(double t) const
	{
		return a + b * t - 9.81 * t * t / 2;
	}
};

using Heights = std::vector<std::pair<double, double>>; // time (s), height (m)

Branch fit_branch(Heights::const_iterator begin, Heights::const_iterator end)
{
	double n = 0, st = 0, stt = 0, sh = 0, sth = 0;
	for (auto i = begin; i != end; ++i) {
		const double t = i->first, h = i->second + 9.81 * t * t / 2;
		n++;
		st += t;
		stt += t * t;
		sh += h;
		sth += t * h;
	}
	const double b = (n * sth - st * sh) / (n * stt - st * st);
	return {(sh - b * st) / n, b};
}

// Where the ball falls before the lowest sighting and rises after it, the two branches meet at the bounce. NaN where
// that is no bounce.
double bounce_height(const Heights &heights, size_t lowest)
{
	if (lowest < around || lowest + around >= heights.size())
		return std::numeric_limits<double>::quiet_NaN();
	const auto at = heights.begin() + static_cast<std::ptrdiff_t>(lowest);
	Heights near(at - around, at + around + 1);
	for (auto &[time, height] : near)
		time -= at->first;
	// The lowest sighting itself may stand on either side: it is left out.
	const Branch falls = fit_branch(near.begin(), near.begin() + around);
	const Branch rises = fit_branch(near.begin() + around + 1, near.end());
	const double t = (falls.a - rises.a) / (rises.b - falls.b);
	const bool bounces = falls.b < -0.3 && rises.b > 0.3 && t > near[around - 1].first - 0.005 &&
			     t < near[around + 1].first + 0.005;
	return bounces ? falls.height(t) : std::numeric_limits<double>::quiet_NaN();
}

// The sightings, flight by flight, in order of time.
using Flights = std::vector<std::vector<pong_sighting>>;

Flights flights_of(const pong_sighting *sightings, int count)
{
	std::vector<pong_sighting> sorted(sightings, sightings + count);
	std::stable_sort(sorted.begin(), sorted.end(), [](const pong_sighting &a, const pong_sighting &b) {
		return a.track != b.track ? a.track < b.track : a.utime < b.utime;
	});
	Flights flights;
	for (const pong_sighting &sighting : sorted) {
		if (flights.empty() || flights.back().back().track != sighting.track)
			flights.emplace_back();
		flights.back().push_back(sighting);
	}
	return flights;
}

void add_bounces(const pong_rig &rig, const std::vector<pong_sighting> &flight, std::vector<Miss> &misses)
{
	Heights heights;
	for (const pong_sighting &sighting : flight) {
		double position[3];
		if (pong_triangulate(rig.camera, sighting.uv[PONG_LEFT], sighting.uv[PONG_RIGHT], position) ==
		    PONG_FOUND)
			heights.emplace_back(1e-6 * static_cast<double>(sighting.utime - flight.front().utime),
					     position[1]);
	}
	for (size_t i = 1; i + 1 < heights.size(); i++)
		if (heights[i].second < heights[i - 1].second && heights[i].second <= heights[i + 1].second)
			misses.push_back({bounce_height(heights, i) - rig.ball.diameter / 2, bounce_sigma});
}

// What is not met, in the same order for every rotation: epipolar distances, then bounces.
struct Misses {
	std::vector<Miss> epipolar, bounces;
};

Misses misses_of(const pong_rig &rig, const Flights &flights)
{
	Misses misses;
	for (const auto &flight : flights) {
		const double sigma = pixel_sigma * std::sqrt(std::max(1.0, static_cast<double>(flight.size()) / alike));
		for (const pong_sighting &sighting : flight)
			misses.epipolar.push_back(
				{pong_epipolar_distance(rig.camera, sighting.uv[PONG_LEFT], sighting.uv[PONG_RIGHT]),
				 sigma});
		if (rig.table.present)
			add_bounces(rig, flight, misses.bounces);
	}
	return misses;
}

pong_rig turned(const pong_rig &rig, pong_side side, const Vector3 &by)
{
	pong_rig result = rig;
	const Camera parts(rig.camera[side]);
	Matrix34 P;
	const Matrix3 M = parts.K * rotation(by) * parts.R;
	P << M, -(M * parts.centre);
	store(P, result.camera[side].P);
	return result;
}

double rms(const std::vector<Miss> &misses)
{
	double squares = 0;
	int count = 0;
	for (const Miss &miss : misses)
		if (std::isfinite(miss.value)) {
			squares += miss.value * miss.value;
			count++;
		}
	return count ? std::sqrt(squares / count) : std::numeric_limits<double>::quiet_NaN();
}

int finite_count(const std::vector<Miss> &misses)
{
	return static_cast<int>(std::count_if(misses.begin(), misses.end(),
					      [](const Miss &miss) { return std::isfinite(miss.value); }));
}

struct Normal {
	Matrix3 A = Matrix3::Identity() / (rotation_sigma * rotation_sigma);
	Vector3 a = Vector3::Zero();
};

// One row for each miss that stays comparable under a small rotation: a bounce may come and go.
void add_rows(const std::vector<Miss> &now, const std::vector<Miss> (&turned_misses)[3], Normal &normal)
{
	for (const auto &misses : turned_misses)
		if (misses.size() != now.size())
			return;
	for (size_t i = 0; i < now.size(); i++) {
		const Vector3 row(turned_misses[0][i].value - now[i].value, turned_misses[1][i].value - now[i].value,
				  turned_misses[2][i].value - now[i].value);
		if (!row.allFinite() || !std::isfinite(now[i].value))
			continue;
		const double distance = std::abs(now[i].value) / now[i].sigma;
		const double weight = (distance <= loss ? 1 : loss / distance) / (now[i].sigma * now[i].sigma);
		normal.A += weight * row * row.transpose() / (step * step);
		normal.a -= weight * now[i].value * row / step;
	}
}

Normal normal_equations(const pong_rig &rig, pong_side side, const Flights &flights, const Vector3 &so_far)
{
	const Misses now = misses_of(turned(rig, side, so_far), flights);
	std::vector<Miss> epipolar[3], bounces[3];
	for (int axis = 0; axis < 3; axis++) {
		const Misses then = misses_of(turned(rig, side, so_far + step * Vector3::Unit(axis)), flights);
		epipolar[axis] = then.epipolar;
		bounces[axis] = then.bounces;
	}
	Normal normal;
	normal.a = -so_far / (rotation_sigma * rotation_sigma);
	add_rows(now.epipolar, epipolar, normal);
	add_rows(now.bounces, bounces, normal);
	return normal;
}

pong_refinement refine(pong_rig &rig, pong_side side, const Flights &flights)
{
	pong_refinement result = {};
	const Misses before = misses_of(rig, flights);
	Vector3 rotation_found = Vector3::Zero();
	Normal normal;
	for (int iteration = 0; iteration < 20; iteration++) {
		normal = normal_equations(rig, side, flights, rotation_found);
		const Vector3 change = normal.A.ldlt().solve(normal.a);
		rotation_found += change;
		if (change.norm() < 1e-9)
			break;
	}
	rig = turned(rig, side, rotation_found);
	const Misses after = misses_of(rig, flights);
	result.sightings = static_cast<int>(after.epipolar.size());
	result.flights = static_cast<int>(flights.size());
	result.bounces = finite_count(after.bounces);
	result.epipolar_before = rms(before.epipolar);
	result.epipolar = rms(after.epipolar);
	result.bounce_before = rms(before.bounces);
	result.bounce = rms(after.bounces);
	store(rotation_found, result.rotation);
	store(Matrix3(normal.A.inverse()), result.covariance);
	return result;
}

} // namespace

} // namespace pong

int pong_refine(pong_rig *rig, pong_side knocked, const pong_sighting *sightings, int count,
		pong_refinement *refinement, pong_error *error)
{
	return pong::guarded(error, [&] {
		if (count < 20)
			throw pong::Fault{
				PONG_ERROR_VALUE,
				pong::sentence("%d sightings are too few to refine from: 20 are needed", count)};
		*refinement = pong::refine(*rig, knocked, pong::flights_of(sightings, count));
		return PONG_FOUND;
	});
}
