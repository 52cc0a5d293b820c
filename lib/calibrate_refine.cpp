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

// An epipolar distance errs by what shading moves one centre more than the other: as much as the ball is large, times
// the angle between the views, which grows with its size too. So sigma is for a ball of `usual_size` and grows as its
// square.
const double usual_size = 15;          // px
const double first_pixel_sigma = 0.1;  // px, before the residuals tell it
const double least_pixel_sigma = 0.02; // px
const double alike = 4;                // a flight counts as so many sightings: its centres err alike, lit alike
// Of a slope of epipolar distances across the picture, px a px: a ball seen from the other side is lit from the other
// side. It looks just like a rotation about the optical axis.
const double shading_slope = 0.0008;
const double established = 1.5;      // a rotation below so many sigma is taken for none
const double gravity = 9.81;         // m/s^2
const double acceleration_sigma = 2; // of what drag and spin add to it, upwards, m/s^2
const double height_noise = 0.0007;  // of a sighting, m
const double bounce_sigma = 0.0005;  // of a bounce's height, what all its sightings err alike, m
const double rotation_sigma = 0.002; // of a knock before anything is known: 0.11 degrees, rad
const double loss = 3;               // Huber's threshold, in sigma
const size_t around = 10;            // sightings on each side of a bounce that are looked at
const double step = 1e-6;            // for derivatives, rad

struct Miss {
	double value, sigma;
};

// Height over time on one side of a bounce: h = a + b t + c t^2. Gravity is known, what drag and spin add is not, so
// that c has a prior; three points tell a line and more of them also how it bends.
struct Branch {
	Vector3 curve;
	Matrix3 covariance;

	double height(double t) const
	{
		return curve.dot(powers(t));
	}
	double rate(double t) const
	{
		return curve[1] + 2 * t * curve[2];
	}
	double variance(double t) const
	{
		return powers(t).dot(covariance * powers(t));
	}
	static Vector3 powers(double t)
	{
		return {1, t, t * t};
	}
};

using Heights = std::vector<std::pair<double, double>>; // time (s), height (m)

Branch fit_branch(Heights::const_iterator begin, Heights::const_iterator end)
{
	const double bend_weight = 1 / (acceleration_sigma * acceleration_sigma / 4);
	const double weight = 1 / (height_noise * height_noise);
	Matrix3 A = Matrix3::Zero();
	Vector3 b = Vector3::Zero();
	A(2, 2) = bend_weight;
	b[2] = -gravity / 2 * bend_weight;
	for (auto i = begin; i != end; ++i) {
		const Vector3 row = Branch::powers(i->first);
		A += weight * row * row.transpose();
		b += weight * i->second * row;
	}
	const Matrix3 covariance = A.inverse();
	return {covariance * b, covariance};
}

// Where two branches meet: Newton's steps from where their tangents do.
double meeting_time(const Branch &falls, const Branch &rises)
{
	double t = 0;
	for (int i = 0; i < 5; i++)
		t -= (falls.height(t) - rises.height(t)) / (falls.rate(t) - rises.rate(t));
	return t;
}

// Where the ball falls before the lowest sighting and rises after it, the two branches meet at the bounce: its height
// over where it should be. NaN where that is no bounce.
Miss bounce_at(const Heights &heights, size_t lowest, double radius)
{
	const Miss none = {std::numeric_limits<double>::quiet_NaN(), 1};
	const size_t before = std::min(lowest, around), after = std::min(heights.size() - lowest - 1, around);
	if (before < 3 || after < 2)
		return none;
	const auto at = heights.begin() + static_cast<std::ptrdiff_t>(lowest);
	Heights near(at - static_cast<std::ptrdiff_t>(before), at + static_cast<std::ptrdiff_t>(after) + 1);
	for (auto &[time, height] : near)
		time -= at->first;
	// The lowest sighting itself may stand on either side: it is left out.
	const auto middle = near.begin() + static_cast<std::ptrdiff_t>(before);
	const Branch falls = fit_branch(near.begin(), middle), rises = fit_branch(middle + 1, near.end());
	const double t = meeting_time(falls, rises);
	const bool bounces = falls.rate(t) < -0.3 && rises.rate(t) > 0.3 && t > middle[-1].first - 0.005 &&
			     t < middle[1].first + 0.005;
	if (!bounces)
		return none;
	// d height = d falls + rate dt with dt = (d falls - d rises) / (difference of rates).
	const double lever = falls.rate(t) / (rises.rate(t) - falls.rate(t));
	const double variance = (1 + lever) * (1 + lever) * falls.variance(t) + lever * lever * rises.variance(t);
	return {falls.height(t) - radius, std::sqrt(variance + bounce_sigma * bounce_sigma)};
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
			misses.push_back(bounce_at(heights, i, rig.ball.diameter / 2));
}

// What is not met, in the same order for every rotation: epipolar distances, then bounces.
struct Misses {
	std::vector<Miss> epipolar, bounces;
};

// Of sigma with the size that the ball appears to have; 1 where the rays do not meet.
double growth(const pong_rig &rig, const pong_sighting &sighting)
{
	double position[3];
	if (pong_triangulate(rig.camera, sighting.uv[PONG_LEFT], sighting.uv[PONG_RIGHT], position) != PONG_FOUND)
		return 1;
	const double size = pong_apparent_size(&rig.camera[PONG_LEFT], position, rig.ball.diameter) / usual_size;
	return std::max(size * size, 0.1);
}

Misses misses_of(const pong_rig &rig, const Flights &flights, double pixel_sigma)
{
	Misses misses;
	for (const auto &flight : flights) {
		const double sigma = pixel_sigma * std::sqrt(std::max(1.0, static_cast<double>(flight.size()) / alike));
		for (const pong_sighting &sighting : flight)
			misses.epipolar.push_back(
				{pong_epipolar_distance(rig.camera, sighting.uv[PONG_LEFT], sighting.uv[PONG_RIGHT]),
				 sigma * growth(rig, sighting)});
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

// What sigma of a ball of the usual size would be, by what half of the misses are below: a false flight does not widen
// it.
double found_pixel_sigma(const pong_rig &rig, const Flights &flights)
{
	std::vector<double> distances;
	for (const auto &flight : flights)
		for (const pong_sighting &sighting : flight)
			distances.push_back(std::abs(pong_epipolar_distance(rig.camera, sighting.uv[PONG_LEFT],
									    sighting.uv[PONG_RIGHT])) /
					    growth(rig, sighting));
	const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
	std::nth_element(distances.begin(), middle, distances.end());
	return std::max(*middle / 0.6745, least_pixel_sigma);
}

int finite_count(const std::vector<Miss> &misses)
{
	return static_cast<int>(std::count_if(misses.begin(), misses.end(),
					      [](const Miss &miss) { return std::isfinite(miss.value); }));
}

struct Normal {
	Matrix3 A = Matrix3::Zero();
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

// The slope that shading may cause is one more unknown, with the same derivatives as the rotation about z: eliminated
// by Schur's complement.
void forget_slope(Normal &normal)
{
	const Vector3 column = normal.A.col(2);
	const double whole = normal.A(2, 2) + 1 / (shading_slope * shading_slope);
	normal.a -= column * normal.a[2] / whole;
	normal.A -= column * column.transpose() / whole;
}

// What is refined, and from what.
struct Knock {
	const pong_rig &rig;
	pong_side side;
	const Flights &flights;
};

Normal normal_equations(const Knock &knock, const Vector3 &so_far, double pixel_sigma)
{
	const auto misses_at = [&](const Vector3 &by) {
		return misses_of(turned(knock.rig, knock.side, by), knock.flights, pixel_sigma);
	};
	const Misses now = misses_at(so_far);
	std::vector<Miss> epipolar[3], bounces[3];
	for (int axis = 0; axis < 3; axis++) {
		const Misses then = misses_at(so_far + step * Vector3::Unit(axis));
		epipolar[axis] = then.epipolar;
		bounces[axis] = then.bounces;
	}
	Normal normal;
	add_rows(now.epipolar, epipolar, normal);
	forget_slope(normal);
	add_rows(now.bounces, bounces, normal);
	normal.A += Matrix3::Identity() / (rotation_sigma * rotation_sigma);
	normal.a -= so_far / (rotation_sigma * rotation_sigma);
	return normal;
}

// Gauss and Newton. Returns the covariance.
Matrix3 find_rotation(const Knock &knock, double pixel_sigma, Vector3 &rotation_found)
{
	Normal normal;
	for (int iteration = 0; iteration < 20; iteration++) {
		normal = normal_equations(knock, rotation_found, pixel_sigma);
		const Vector3 change = normal.A.ldlt().solve(normal.a);
		rotation_found += change;
		if (change.norm() < 1e-9)
			break;
	}
	return normal.A.inverse();
}

// The rotation about those of the camera's axes alone for which one is established: what the others show may be chance,
// and would be made up for by the wrong one. Of all sets of axes that may be held the largest, and of these the
// likeliest.
Vector3 established_part(const Vector3 &found, const Matrix3 &covariance)
{
	Vector3 best = found;
	size_t most = 0;
	double least = std::numeric_limits<double>::infinity();
	for (int set = 1; set < 8; set++) {
		std::vector<int> held;
		for (int axis = 0; axis < 3; axis++)
			if (set & 1 << axis)
				held.push_back(axis);
		const Eigen::MatrixXd among = covariance(held, held), with = covariance(Eigen::all, held);
		const Eigen::VectorXd scaled = among.ldlt().solve(found(held));
		const double cost = found(held).dot(scaled);
		if (cost > established * established * static_cast<double>(held.size()) || held.size() < most ||
		    (held.size() == most && cost >= least))
			continue;
		most = held.size();
		least = cost;
		best = found - with * scaled;
	}
	return best;
}

pong_refinement refine(pong_rig &rig, pong_side side, const Flights &flights)
{
	pong_refinement result = {};
	const Misses before = misses_of(rig, flights, first_pixel_sigma);
	const Knock knock = {rig, side, flights};
	Vector3 rotation_found = Vector3::Zero();
	find_rotation(knock, first_pixel_sigma, rotation_found);
	const double pixel_sigma = found_pixel_sigma(turned(rig, side, rotation_found), flights);
	const Matrix3 covariance = find_rotation(knock, pixel_sigma, rotation_found);
	rotation_found = established_part(rotation_found, covariance);
	rig = turned(rig, side, rotation_found);
	const Misses after = misses_of(rig, flights, first_pixel_sigma);
	result.sightings = static_cast<int>(after.epipolar.size());
	result.flights = static_cast<int>(flights.size());
	result.bounces = finite_count(after.bounces);
	result.epipolar_before = rms(before.epipolar);
	result.epipolar = rms(after.epipolar);
	result.bounce_before = rms(before.bounces);
	result.bounce = rms(after.bounces);
	store(rotation_found, result.rotation);
	store(covariance, result.covariance);
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
