// A stereo pair as the message of a recording, and back: whole pictures, or the parts of them that are worth keeping.
#pragma once

#include <cstdint>
#include <vector>

#include "pongeye/pair_t.hpp"
#include "source.hpp"

namespace track
{

// What is kept of a picture, px; of size 0: nothing.
struct Part {
	int u = 0, v = 0, width = 0, height = 0;
};

struct Parts {
	Part of[2]; // by pong_side
};

Parts whole_of(const StereoPair &pair);

// The parts lie within the pictures. Allocates nothing where message.pixels has room.
void pack(const StereoPair &pair, const Parts &parts, int64_t number, pongeye::pair_t &message);

// Decodes a message from anywhere. False where it is not one that pack() could have made.
bool decode(const std::vector<uint8_t> &data, pongeye::pair_t &message);

// Makes pictures of parts: what a message does not have stays as the last whole picture had it.
class Unpacker
{
public:
	// The pictures borrow from the message and from here. False where a whole pair has not come yet.
	bool unpack(const pongeye::pair_t &message, StereoPair &pair);

private:
	struct Canvas {
		int width = 0, height = 0;
		std::vector<uint8_t> last_whole, pixels;
		Part pasted;
	};

	static pong_image paste(Canvas &canvas, const Part &part, const uint8_t *pixels);

	Canvas canvas_[2]; // by pong_side
};

} // namespace track
