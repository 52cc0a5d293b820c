#include "ball_pixels.hpp"

#include <algorithm>
#include <cmath>

#include "clones.hpp"

namespace pong
{

namespace
{

const float outside = 3.5f;        // of the outline, how far pixels are looked at, px
const float rim = 2.5f;            // inside of it, how far all are, px
const float bare = 1.75f;          // so far outside only background is seen, px
const int inner_part = 5;          // of the inside, one pixel in so many
const int outline_pixels = 450;    // of the outline of a large ball, about so many
const double background_error = 5; // of an earlier picture that shows what is behind the ball, but for its light: grey
				   // levels, standard deviation
const double light_change = 0.4;   // of that light, at most
const float rise_most = 8;         // of the background, grey levels per px: an edge that is sharper is not straight
const int row_max = 512;

// How a picture's grey level varies: read and rounding noise, and shot noise per grey level, about. Only their relation
// matters: the residuals tell the scale.
float sensor_variance(float level)
{
	const float read = 0.5f, shot = 1.0f / 80;
	return read + shot * level;
}

// 16 of a kind: by signs, by which coordinate is greater, and by half of that.
int sector_of(float along_u, float along_v)
{
	const float x = std::abs(along_u), y = std::abs(along_v);
	const float less = std::min(x, y), more = std::max(x, y);
	return 8 * (along_u < 0) + 4 * (along_v < 0) + 2 * (x < y) + (less > 0.41f * more);
}

// What an earlier picture shows just outside of the ball, against the current one, in one sector.
struct Difference {
	double sum = 0, squares = 0, level = 0, count = 0;

	void add(float now, float earlier)
	{
		sum += now - earlier;
		squares += (now - earlier) * (now - earlier);
		level += earlier;
		count++;
	}

	// Infinite where the light has changed too much.
	double variance() const
	{
		if (!(std::abs(sum) <= light_change * level))
			return INFINITY;
		return (squares - sum * sum / count) / count;
	}
};

// The distance of places from the way of the centre, less the radius; from `half` on either side of the origin.
PONG_CLONES void outline_distance(const float *x, const float *y, int count, float half_x, float half_y, float radius,
				  float *distance)
{
	const float way2 = half_x * half_x + half_y * half_y, per_way2 = way2 > 0 ? 1 / way2 : 0;
	for (int i = 0; i < count; i++) {
		float along = (x[i] * half_x + y[i] * half_y) * per_way2;
		along = along < -1 ? -1 : along > 1 ? 1 : along;
		const float dx = x[i] - along * half_x, dy = y[i] - along * half_y;
		distance[i] = std::sqrt(dx * dx + dy * dy) - radius;
	}
}

float value(const pong_image &image, int u, int v)
{
	return image.pixels[v * image.stride + u];
}

class Chooser
{
public:
	Chooser(const LocateTask &task, BallPixels *pixels) : task_(task), pixels_(pixels)
	{
	}

	void add(int u, int v, float x, float y, float distance)
	{
		const int b = count_ / block, i = count_ % block, sector = sector_of(x, y);
		SphereBlock &to = pixels_->blocks[b];
		const float now = value(task_.pictures.current, u, v);
		to.u[i] = x;
		to.v[i] = y;
		pixels_->now[b][i] = now;
		pixels_->weight[b][i] = distance; // until the background is known
		pixels_->patch[b][i] = static_cast<uint8_t>(sector + (distance > -rim ? sectors : 0));
		to.background[i] = value(task_.pictures.earlier[0], u, v);
		older_[b][i] = value(task_.pictures.earlier[1], u, v);
		u_[b][i] = u;
		v_[b][i] = v;
		if (distance > bare) {
			difference_[0][sector].add(now, to.background[i]);
			difference_[1][sector].add(now, older_[b][i]);
		}
		count_++;
	}

	bool full() const
	{
		return count_ == pixels_max;
	}

	// By direction, the background is from the earlier picture that shows what the current one does.
	void finish()
	{
		bool older[sectors], known[sectors];
		for (int sector = 0; sector < sectors; sector++) {
			const double variance[2] = {difference_[0][sector].variance(),
						    difference_[1][sector].variance()};
			older[sector] = variance[1] < variance[0];
			known[sector] = variance[older[sector]] <= background_error * background_error;
		}
		for (int n = 0; n < count_; n++) {
			const int b = n / block, i = n % block, sector = pixels_->patch[b][i] % sectors;
			float &background = pixels_->blocks[b].background[i], &weight = pixels_->weight[b][i];
			if (older[sector])
				background = older_[b][i];
			rise(task_.pictures.earlier[older[sector]], b, i);
			// Where no ball is, the earlier picture's noise counts too.
			const float distance = weight;
			const float seen = std::clamp(distance / bare + 0.5f, 0.0f, 1.0f);
			const float variance =
				sensor_variance(pixels_->now[b][i]) + seen * seen * sensor_variance(background);
			weight = known[sector] || distance < -bare ? 1 / variance : 0;
		}
		pixels_->count = (count_ + block - 1) / block;
		for (; count_ % block; count_++) {
			SphereBlock &to = pixels_->blocks[count_ / block];
			const int i = count_ % block;
			to.u[i] = to.v[i] = to.background[i] = to.rise_u[i] = to.rise_v[i] = 0;
			pixels_->now[count_ / block][i] = pixels_->weight[count_ / block][i] = 0;
			pixels_->patch[count_ / block][i] = 0;
		}
	}

private:
	// Central differences; the plane's axes are the picture's, but for little.
	void rise(const pong_image &image, int b, int i)
	{
		const int u = u_[b][i], v = v_[b][i];
		const int left = std::max(u - 1, 0), right = std::min(u + 1, image.width - 1);
		const int above = std::max(v - 1, 0), below = std::min(v + 1, image.height - 1);
		const auto gentle = [](float rise) { return std::clamp(rise, -rise_most, rise_most); };
		pixels_->blocks[b].rise_u[i] = gentle((value(image, right, v) - value(image, left, v)) / 2);
		pixels_->blocks[b].rise_v[i] = gentle((value(image, u, below) - value(image, u, above)) / 2);
	}

	const LocateTask &task_;
	BallPixels *pixels_;
	int count_ = 0;
	float older_[blocks_max][block];
	int u_[blocks_max][block], v_[blocks_max][block];
	Difference difference_[2][sectors];
};

} // namespace

void choose_pixels(const LocateTask &task, const PlaneMap &map, const BallPlace &place, BallPixels *pixels)
{
	const pong_image &image = task.pictures.current;
	const double reach_u = 1.05 * place.radius + std::abs(task.streak.x()) / 2;
	const double reach_v = 1.05 * place.radius + std::abs(task.streak.y()) / 2;
	const auto clamp = [](double x, int most) { return std::clamp(static_cast<int>(std::floor(x)), 0, most); };
	const double u = place.centre.x(), v = place.centre.y();
	const int first_u = clamp(u - reach_u - outside, image.width - 1);
	const int last_u = clamp(u + reach_u + outside + 1, std::min(image.width - 1, first_u + row_max - 1));
	const int first_v = clamp(v - reach_v - outside, image.height - 1);
	const int last_v = clamp(v + reach_v + outside + 1, image.height - 1);
	const double lens = 1; // px that its blur may cost
	pixels->cut = u - reach_u < -lens || v - reach_v < -lens || u + reach_u > image.width - 1 + lens ||
		      v + reach_v > image.height - 1 + lens;
	const double outline = (2 * M_PI * place.radius + 4 * place.half.norm()) * (outside + rim);
	const int part = std::max(1, static_cast<int>(outline / outline_pixels + 0.5));
	const float radius = static_cast<float>(place.radius);
	Chooser chooser(task, pixels);
	for (int row = first_v; row <= last_v; row++) {
		float x[row_max], y[row_max], distance[row_max];
		const int count = last_u - first_u + 1;
		map.row(row, first_u, count, x, y);
		outline_distance(x, y, count, static_cast<float>(place.half.x()), static_cast<float>(place.half.y()),
				 radius, distance);
		for (int i = 0; i < count && !chooser.full(); i++) {
			const int column = first_u + i;
			// Lattices: of n pixels in a row or a column one.
			const bool wanted = distance[i] < -rim ? (column + 2 * row) % inner_part == 0
							       : distance[i] < outside && (column + row) % part == 0;
			if (wanted)
				chooser.add(column, row, x[i], y[i], distance[i]);
		}
	}
	chooser.finish();
}

} // namespace pong
