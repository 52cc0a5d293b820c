#include "faults.hpp"

#include <algorithm>
#include <utility>

namespace gige
{

Faults::Faults(std::vector<Fault> faults, double rate, uint64_t seed)
	: faults_(std::move(faults)), rate_(rate), random_(seed)
{
}

const Fault *Faults::find(FaultKind kind, int64_t pulse) const
{
	const double time = std::max(0.0, static_cast<double>(pulse - 1) / rate_);
	const auto fault = std::find_if(faults_.begin(), faults_.end(), [kind, time](const Fault &one) {
		return one.kind == kind && time >= one.begin && time < one.end;
	});
	return fault == faults_.end() ? nullptr : &*fault;
}

double Faults::amount(FaultKind kind, int64_t pulse, double none) const
{
	const Fault *fault = find(kind, pulse);
	return fault ? fault->amount : none;
}

bool Faults::strikes(FaultKind kind, int64_t pulse)
{
	const double probability = amount(kind, pulse);
	if (probability <= 0)
		return false;
	const std::lock_guard<std::mutex> lock(mutex_);
	return std::uniform_real_distribution<double>(0, 1)(random_) < probability;
}

} // namespace gige
