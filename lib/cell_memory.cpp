#include "cell_memory.hpp"

#include <algorithm>

namespace pong
{

CellMemory::CellMemory(int width, int height, int expected) : columns_(width / cell_size), rows_(height / cell_size)
{
	pictures_.reserve(capacity);
	for (int i = 0; i < expected; i++)
		add_place();
}

void CellMemory::add_place()
{
	pictures_.push_back({nullptr, 0, std::vector<uint16_t>(static_cast<size_t>(columns_ * rows_ + cells_beside))});
}

CellMemory::Remembered &CellMemory::place_of(const pong_image &image)
{
	const auto known = std::find_if(pictures_.begin(), pictures_.end(),
					[&](const Remembered &picture) { return picture.is(image); });
	if (known != pictures_.end())
		return *known;
	if (used_ == capacity) {
		Remembered &forgotten = pictures_[oldest_];
		oldest_ = (oldest_ + 1) % capacity;
		return forgotten;
	}
	if (used_ == pictures_.size())
		add_place();
	return pictures_[used_++];
}

void CellMemory::remember(const pong_image &image)
{
	Remembered &place = place_of(image);
	place.pixels = image.pixels;
	place.stride = image.stride;
	for (int row = 0; row < rows_; row++)
		sum_cells(image.pixels + row * cell_size * place.stride, place.stride, columns_,
			  &place.cells[static_cast<size_t>(row) * static_cast<size_t>(columns_)]);
}

const uint16_t *CellMemory::cells_of(const pong_image &image)
{
	for (size_t i = 0; i < used_; i++) {
		latest_ = latest_ + 1 < used_ ? latest_ + 1 : 0;
		if (pictures_[latest_].is(image))
			return pictures_[latest_].cells.data();
	}
	return nullptr;
}

} // namespace pong
