#include "wire.hpp"

namespace gige
{

void Wire::send(const Endpoint &to, const Bytes &packet, int64_t pulse)
{
	if (faults_.strikes(FaultKind::lose, pulse))
		return;
	const std::lock_guard<std::mutex> lock(mutex_);
	if (overtaken_.empty() && faults_.strikes(FaultKind::reorder, pulse)) {
		overtaken_ = packet;
		overtaken_to_ = to;
		return;
	}
	socket_.send(to, packet);
	if (overtaken_.empty())
		return;
	socket_.send(overtaken_to_, overtaken_);
	overtaken_.clear();
}

} // namespace gige
