// The room as one camera sees it, drawn once: in samples, for what moves in front of it, and in pixels.
#pragma once

#include "lens.hpp"
#include "sensor.hpp"
#include "sphere.hpp"

namespace sim
{

class Backdrop
{
public:
	Backdrop(const Room &room, const Lens &lens, const Sensor &sensor);

	// The samples that cover `pixels`, which lie within the lens's margin of the picture; nothing covers them yet.
	void copy(const Rect &pixels, const Lens &lens, Samples *samples) const;

	// Hang the net in front of what was drawn behind it on copied samples.
	void add_net(const Rect &pixels, Samples *samples) const;

	// By pixels, row by row.
	const std::vector<Fixed> &light() const;
	const std::vector<Fixed> &deviation() const;
	// How much of a pixel sees past the table to the wall and the floor, 0 to 1.
	const std::vector<float> &beyond() const;
	// Depth of what a pixel's centre sees, m.
	double depth(int u, int v) const;

private:
	size_t index(int column, int row) const; // of a sample, counted from the picture's top left pixel

	int margin_, columns_;
	std::vector<float> level_, depth_;
	std::vector<uint8_t> net_cover_, net_level_; // cover in 1/255
	std::vector<Fixed> light_, deviation_;
	std::vector<float> beyond_;
};

} // namespace sim
