// Any datagrams at any time to a simulated camera's control port, while it streams.
//
// The input is a row of datagrams, each with a byte before it that says how long it is and whether it comes from the
// same client as the one before, and a byte for the time that passes.
#include <algorithm>
#include <cstdlib>

#include "simulate/gige/control.hpp"

namespace
{

constexpr uint8_t OTHER_CLIENT = 0x80;
constexpr int64_t STEP_NS = 20000000;

// A few pictures to be asked for again.
void fill(gige::FrameRing &ring)
{
	for (uint16_t id = 1; id <= 4; id++) {
		gige::Frame frame;
		frame.id = id;
		frame.region = {32, 24, 0, 0};
		frame.packet_size = 576;
		frame.data.resize(gige::payload_size(frame.region, false));
		ring.add(frame);
	}
}

// What the sender relies on.
void check(const gige::Answer &answer, const gige::Acquisition &acquisition)
{
	if (!answer.reply.empty() && answer.reply.size() < gige::gvcp::header_size)
		abort();
	if (acquisition.session != 0 && (acquisition.packet_size < gige::gvsp::min_packet_size ||
					 acquisition.packet_size > gige::gvsp::max_packet_size))
		abort();
	const gige::Region &region = acquisition.region;
	if (region.x + region.width > 640 || region.y + region.height > 480)
		abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	gige::FrameRing ring;
	fill(ring);
	gige::Control control({0x7f000001, "fuzz", 640, 480, 0.002, 0}, ring);
	int64_t now = STEP_NS;
	while (size >= 2) {
		const uint16_t port = data[0] & OTHER_CLIENT ? 2000 : 1000;
		const size_t length = std::min<size_t>(data[0] & ~OTHER_CLIENT, size - 2);
		now += data[1] * STEP_NS;
		check(control.handle(data + 2, length, {0x7f000001, port}, now), control.acquisition());
		control.discover(data + 2, length);
		data += 2 + length;
		size -= 2 + length;
	}
	return 0;
}
