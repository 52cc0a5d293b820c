#include "noise.hpp"

#include <algorithm>
#include <cmath>

namespace pong
{

namespace
{

const double usual_sigma = 0.001; // m; what is believed before,
const double belief = 2;          // as if seen so often
const double memory = 6;          // differences: a ball far away is seen less well than it will be soon
const double surprise = 9;        // a square so many times the usual one is a bounce or an outlier, and counts no more

} // namespace

Noise::Noise(double shared) : shared_(shared)
{
	clear();
}

void Noise::clear()
{
	count_ = 0;
	weight_ = belief;
	sum_.setConstant(belief * usual_sigma * usual_sigma);
}

// The third divided difference, sum of x_i / prod (t_i - t_j), scaled so that its variance is that of one point.
void Noise::add(int64_t utime, const Vector3 &position)
{
	std::rotate(latest_.begin(), latest_.begin() + 1, latest_.end());
	latest_.back() = {utime, position};
	if (++count_ < latest_.size())
		return;
	Vector3 difference = Vector3::Zero();
	double squares = 0;
	for (const Place &one : latest_) {
		double product = 1;
		for (const Place &other : latest_)
			if (other.utime != one.utime)
				product *= static_cast<double>(one.utime - other.utime) * 1e-6;
		difference += one.position / product;
		squares += 1 / (product * product);
	}
	const Vector3 usual = sum_ / weight_;
	sum_ += (difference.cwiseAbs2() / squares).cwiseMin(surprise * usual);
	weight_++;
	if (weight_ > memory) {
		sum_ *= memory / weight_;
		weight_ = memory;
	}
}

Vector3 Noise::sigma() const
{
	return ((sum_ / weight_).array() + shared_ * shared_).sqrt();
}

} // namespace pong
