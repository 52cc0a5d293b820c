#include "pair_message.hpp"

#include <cstring>

#include "big_endian.hpp"

namespace track
{

namespace
{

constexpr int LARGEST_SIDE = 16384; // px

// A message is its type's hash, three numbers of 64 bits, twelve of 32, the size of the pixels, and the pixels.
constexpr size_t HEAD = 8 + 3 * 8 + 12 * 4 + 4;

size_t size_of(const Part &part)
{
	return static_cast<size_t>(part.width) * static_cast<size_t>(part.height);
}

Part part_of(const pongeye::pair_t &message, int side)
{
	return {message.part_u[side], message.part_v[side], message.part_width[side], message.part_height[side]};
}

bool is_whole(const pongeye::pair_t &message, int side)
{
	return message.part_width[side] == message.width[side] && message.part_height[side] == message.height[side];
}

bool is_absent(const pongeye::pair_t &message, int side)
{
	return message.width[side] == 0 && message.height[side] == 0 && size_of(part_of(message, side)) == 0;
}

bool lies_within(const Part &part, int width, int height)
{
	return width > 0 && width <= LARGEST_SIDE && height > 0 && height <= LARGEST_SIDE && part.u >= 0 &&
	       part.v >= 0 && part.width >= 0 && part.height >= 0 && part.width <= width && part.height <= height &&
	       part.u <= width - part.width && part.v <= height - part.height;
}

void copy_rows(uint8_t *to, ptrdiff_t to_stride, const uint8_t *from, ptrdiff_t from_stride, const Part &part)
{
	for (int v = 0; v < part.height; v++)
		memcpy(to + v * to_stride, from + v * from_stride, static_cast<size_t>(part.width));
}

// The place of a part's first pixel.
size_t place_in(const Part &part, ptrdiff_t stride)
{
	return static_cast<size_t>(part.v * stride + part.u);
}

} // namespace

Parts whole_of(const StereoPair &pair)
{
	return {{{0, 0, pair.left.width, pair.left.height}, {0, 0, pair.right.width, pair.right.height}}};
}

size_t encoded_size(const Parts &parts)
{
	return HEAD + size_of(parts.of[PONG_LEFT]) + size_of(parts.of[PONG_RIGHT]);
}

void encode(const StereoPair &pair, const Parts &parts, int64_t number, uint8_t *bytes)
{
	pongeye::pair_t head;
	head.utime = pair.utime;
	head.frame = pair.frame;
	head.number = number;
	head.size = 0;
	uint8_t *pixels = bytes + HEAD;
	for (const int side : {PONG_LEFT, PONG_RIGHT}) {
		const pong_image &image = side == PONG_LEFT ? pair.left : pair.right;
		const Part &part = parts.of[side];
		head.width[side] = image.width;
		head.height[side] = image.height;
		head.part_u[side] = part.u;
		head.part_v[side] = part.v;
		head.part_width[side] = part.width;
		head.part_height[side] = part.height;
		copy_rows(pixels, part.width, image.pixels + place_in(part, image.stride), image.stride, part);
		pixels += size_of(part);
	}
	head.encode(bytes, 0, static_cast<int>(HEAD));
	store32(bytes + HEAD - 4, static_cast<uint32_t>(pixels - bytes - HEAD));
}

// The generated decoder believes the size that the message states, and makes that much room: look at it first.
bool decode(const std::vector<uint8_t> &data, pongeye::pair_t &message)
{
	if (data.size() < HEAD)
		return false;
	const uint32_t size = load32(data.data() + HEAD - 4);
	if (size != data.size() - HEAD || message.decode(data.data(), 0, static_cast<int>(data.size())) < 0)
		return false;
	size_t expected = 0;
	for (const int side : {PONG_LEFT, PONG_RIGHT}) {
		const Part part = part_of(message, side);
		if (!is_absent(message, side) && !lies_within(part, message.width[side], message.height[side]))
			return false;
		expected += size_of(part);
	}
	return expected == size;
}

int pictures_of(const pongeye::pair_t &message)
{
	return !is_absent(message, PONG_LEFT) + !is_absent(message, PONG_RIGHT);
}

// The canvas is the last whole picture, with one part pasted in.
pong_image Unpacker::paste(Canvas &canvas, const Part &part, const uint8_t *pixels)
{
	const ptrdiff_t stride = canvas.width;
	if (canvas.pixels.empty()) {
		canvas.pixels = canvas.last_whole;
		canvas.pasted = {};
	}
	const size_t before = place_in(canvas.pasted, stride);
	copy_rows(canvas.pixels.data() + before, stride, canvas.last_whole.data() + before, stride, canvas.pasted);
	copy_rows(canvas.pixels.data() + place_in(part, stride), stride, pixels, part.width, part);
	canvas.pasted = part;
	return {canvas.pixels.data(), canvas.width, canvas.height, stride};
}

bool Unpacker::unpack(const pongeye::pair_t &message, StereoPair &pair)
{
	const uint8_t *pixels = message.pixels.data();
	pair.utime = message.utime;
	pair.frame = message.frame;
	for (const int side : {PONG_LEFT, PONG_RIGHT}) {
		Canvas &canvas = canvas_[side];
		const Part part = part_of(message, side);
		pong_image &image = side == PONG_LEFT ? pair.left : pair.right;
		if (is_absent(message, side)) {
			image = {};
		} else if (is_whole(message, side)) {
			image = {pixels, part.width, part.height, part.width};
			canvas.width = part.width;
			canvas.height = part.height;
			canvas.last_whole.assign(pixels, pixels + size_of(part));
			canvas.pixels.clear();
		} else if (canvas.width == message.width[side] && canvas.height == message.height[side]) {
			image = paste(canvas, part, pixels);
		} else {
			return false;
		}
		pixels += size_of(part);
	}
	return true;
}

} // namespace track
