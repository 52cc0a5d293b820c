// The cells of pictures that later ones are compared with: they need not be summed again, nor their pixels be read.
#pragma once

#include <vector>

#include "cells.hpp"

namespace pong
{

class CellMemory
{
public:
	// There is memory for so many pictures at once; for more it is asked for when they come.
	CellMemory(int width, int height, int expected);

	// A picture at the place of another one takes its place here, too.
	void remember(const pong_image &image);

	// Rows of width / cell_size sums; null of a picture that is not remembered. They are found soonest in the order
	// in which they came.
	const uint16_t *cells_of(const pong_image &image);

private:
	struct Remembered {
		const uint8_t *pixels;
		ptrdiff_t stride;
		std::vector<uint16_t> cells;

		bool is(const pong_image &image) const
		{
			return pixels == image.pixels && stride == image.stride;
		}
	};

	void add_place();
	Remembered &place_of(const pong_image &image);

	static const size_t capacity = 256; // pictures; then the oldest is forgotten
	int columns_, rows_;
	std::vector<Remembered> pictures_;
	size_t used_ = 0, oldest_ = 0;
	size_t latest_ = 0; // that was asked for
};

} // namespace pong
