// A stereo pair as the message of a recording, and back: whole pictures, or the parts of them that are worth keeping.
// A picture without a partner is a pair of which one picture has size 0.
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

// The message with these parts, which lie within the pictures: how many bytes it takes, and the bytes. The pixels are
// copied once and nothing is allocated, which the generated encoder, from vectors, cannot do.
size_t encoded_size(const Parts &parts);
void encode(const StereoPair &pair, const Parts &parts, int64_t number, uint8_t *bytes);

// Decodes a message from anywhere. False where it is not one that encode() could have made.
bool decode(const std::vector<uint8_t> &data, pongeye::pair_t &message);

// How many pictures it has: two, or that of one camera alone.
int pictures_of(const pongeye::pair_t &message);

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
