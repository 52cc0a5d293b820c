// How far points scatter, for points that come without a covariance: found out from the points themselves.
//
// Of four neighbouring points the combination that vanishes on every parabola in time is left with noise only: the
// flight between neighbours hardly differs from a parabola.
#pragma once

#include <array>

#include "camera.hpp"

namespace pong
{

class Noise
{
public:
	static const size_t reach = 4; // neighbours in a combination

	// What neighbours err alike with does not show in their scatter: `shared`, its standard deviation, m.
	explicit Noise(double shared);

	void clear();
	void add(int64_t utime, const Vector3 &position);

	// Standard deviations of x, y, z, m, of the latest points.
	Vector3 sigma() const;

private:
	struct Place {
		int64_t utime;
		Vector3 position;
	};
	double shared_;
	std::array<Place, reach> latest_;
	size_t count_ = 0;
	Vector3 sum_; // of squares
	double weight_;
};

} // namespace pong
