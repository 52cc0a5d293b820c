#include "latency.hpp"

#include <algorithm>
#include <cmath>

namespace track
{

void Latencies::add(double seconds)
{
	const double bin = std::log(std::max(seconds, SHORTEST) / SHORTEST) / std::log(GROWTH);
	counts_[static_cast<size_t>(std::min(bin, BINS - 1.0))]++;
	total_++;
	max_ = std::max(max_, seconds);
}

void Latencies::clear()
{
	*this = Latencies();
}

double Latencies::percentile(double part) const
{
	if (total_ == 0)
		return NAN;
	const int64_t rank = std::max<int64_t>(1, std::llround(std::ceil(part * static_cast<double>(total_))));
	int64_t below = 0;
	size_t bin = 0;
	while ((below += counts_[bin]) < rank)
		bin++;
	return std::min(SHORTEST * std::pow(GROWTH, static_cast<double>(bin + 1)), max_);
}

double Latencies::max() const
{
	return total_ ? max_ : NAN;
}

} // namespace track
