// Any bytes as a recording: every pixel of every picture that comes out is read.
#include "bytes_file.hpp"
#include "program.hpp"
#include "track/replay.hpp"

namespace
{

volatile unsigned sink;

void read_pixels(const pong_image &image)
{
	unsigned sum = 0;
	for (int v = 0; v < image.height; v++)
		for (int u = 0; u < image.width; u++)
			sum += image.pixels[v * image.stride + u];
	sink = sum;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
	const BytesFile file(data, size);
	try {
		track::Replay replay(file.path());
		try {
			track::make_setup(replay.rig(), replay.profile());
		} catch (const pong::Failure &) {
			// The rig is no rig: given another, the pictures are replayed all the same.
		}
		track::StereoPair pair;
		while (replay.next(pair) != track::Next::END) {
			read_pixels(pair.left);
			read_pixels(pair.right);
		}
	} catch (const pong::Failure &) {
		return 0; // one sentence: as it should be
	}
	return 0;
}
