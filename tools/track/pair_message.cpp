#include "pair_message.hpp"

#include <cstring>
#include <stdexcept>

namespace track
{

namespace
{

constexpr int LARGEST_SIDE = 16384; // px

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

void pack(const StereoPair &pair, const Parts &parts, int64_t number, pongeye::pair_t &message)
{
	message.utime = pair.utime;
	message.frame = pair.frame;
	message.number = number;
	message.pixels.resize(size_of(parts.of[PONG_LEFT]) + size_of(parts.of[PONG_RIGHT]));
	message.size = static_cast<int32_t>(message.pixels.size());
	uint8_t *to = message.pixels.data();
	for (const int side : {PONG_LEFT, PONG_RIGHT}) {
		const pong_image &image = side == PONG_LEFT ? pair.left : pair.right;
		const Part &part = parts.of[side];
		message.width[side] = image.width;
		message.height[side] = image.height;
		message.part_u[side] = part.u;
		message.part_v[side] = part.v;
		message.part_width[side] = part.width;
		message.part_height[side] = part.height;
		copy_rows(to, part.width, image.pixels + place_in(part, image.stride), image.stride, part);
		to += size_of(part);
	}
}

// The generated decoder believes the size that the message states, and makes that much room: look at it first. It
// stands before the pixels, and they end the message.
bool decode(const std::vector<uint8_t> &data, pongeye::pair_t &message)
{
	static const size_t head = [] {
		pongeye::pair_t empty;
		empty.size = 0;
		return static_cast<size_t>(empty.getEncodedSize());
	}();
	if (data.size() < head)
		return false;
	const uint8_t *stated = data.data() + head - 4;
	const uint32_t size =
		uint32_t{stated[0]} << 24 | uint32_t{stated[1]} << 16 | uint32_t{stated[2]} << 8 | stated[3];
	if (size != data.size() - head || message.decode(data.data(), 0, static_cast<int>(data.size())) < 0)
		return false;
	size_t expected = 0;
	for (const int side : {PONG_LEFT, PONG_RIGHT}) {
		const Part part = part_of(message, side);
		if (!lies_within(part, message.width[side], message.height[side]))
			return false;
		expected += size_of(part);
	}
	return expected == size && message.number >= 1;
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
		if (is_whole(message, side)) {
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
