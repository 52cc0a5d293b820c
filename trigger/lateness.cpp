#include "lateness.hpp"

#include <algorithm>

#include "program.hpp"

namespace pong
{

void Lateness::add(double seconds)
{
	size_t bin = 0;
	while (bin < ENDS.size() && seconds * 1e6 >= ENDS[bin])
		bin++;
	bins_[bin]++;
	late_ += seconds > LATE;
	worst_ = std::max(worst_, seconds);
}

int64_t Lateness::late() const
{
	return late_;
}

double Lateness::worst() const
{
	return worst_;
}

std::string Lateness::text() const
{
	std::string lines;
	for (size_t i = 0; i < bins_.size(); i++) {
		const bool last = i == ENDS.size();
		lines += format("  %s %5d us  %lld\n", last ? ">=" : " <", ENDS[last ? i - 1 : i],
				static_cast<long long>(bins_[i]));
	}
	return lines;
}

} // namespace pong
