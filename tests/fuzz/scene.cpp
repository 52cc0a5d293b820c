// Any bytes as a scene of the simulator.
#include "simulate/scene.hpp"
#include "program.hpp"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	try {
		sim::parse_scene(std::string(reinterpret_cast<const char *>(data), size), "fuzz");
	} catch (const pong::Failure &) {
		return 0; // one sentence: as it should be
	}
	return 0;
}
