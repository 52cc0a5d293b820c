#include "tangent.hpp"

#include <cmath>

#include "clones.hpp"

namespace pong
{

TangentPlane::TangentPlane(const Camera &camera, const Vector2 &pixel)
	: focal(std::sqrt(camera.K(0, 0) * camera.K(1, 1)))
{
	frame.row(2) = camera.undistort(pixel).homogeneous().normalized();
	frame.row(0) = Vector3::UnitY().cross(frame.row(2)).normalized();
	frame.row(1) = frame.row(2).cross(frame.row(0));
}

Vector2 TangentPlane::from_pixel(const Camera &camera, const Vector2 &pixel) const
{
	return focal * (frame * camera.undistort(pixel).homogeneous()).hnormalized();
}

Vector2 TangentPlane::to_pixel(const Camera &camera, const Vector2 &place) const
{
	const Vector3 ray = frame.transpose() * Vector3(place.x() / focal, place.y() / focal, 1);
	return camera.distort(ray.hnormalized());
}

// Through f(-1), f(0), f(1) goes f(0) + s (f(1) - f(-1)) / 2 + s^2 ((f(1) + f(-1)) / 2 - f(0)): first along the rows,
// then across them.
PlaneMap::PlaneMap(const TangentPlane &plane, const Camera &camera, const Vector2 &pixel, double around)
	: middle(pixel), reach(around)
{
	const auto parabola = [](const Vector2 &before, const Vector2 &here, const Vector2 &after, Vector2 out[3]) {
		out[0] = here;
		out[1] = (after - before) / 2;
		out[2] = (after + before) / 2 - here;
	};
	Vector2 rows[3][3];
	for (int j = 0; j < 3; j++) {
		Vector2 value[3];
		for (int i = 0; i < 3; i++)
			value[i] = plane.from_pixel(camera, middle + reach * Vector2(i - 1, j - 1));
		parabola(value[0], value[1], value[2], rows[j]);
	}
	for (int i = 0; i < 3; i++) {
		Vector2 column[3];
		parabola(rows[0][i], rows[1][i], rows[2][i], column);
		for (int j = 0; j < 3; j++)
			at[j][i] = column[j];
	}
}

Vector2 PlaneMap::operator()(const Vector2 &pixel) const
{
	const Vector2 part = (pixel - middle) / reach;
	Vector2 place(0, 0);
	for (int j = 2; j >= 0; j--)
		place = place * part.y() + at[j][0] + part.x() * (at[j][1] + part.x() * at[j][2]);
	return place;
}

PONG_CLONES static void fill_row(const float a[3], const float b[3], float first, float step, int count, float *x,
				 float *y)
{
	for (int i = 0; i < count; i++) {
		const float s = first + step * static_cast<float>(i);
		x[i] = a[0] + s * (a[1] + s * a[2]);
		y[i] = b[0] + s * (b[1] + s * b[2]);
	}
}

void PlaneMap::row(int v, int begin, int count, float *x, float *y) const
{
	const double t = (v - middle.y()) / reach;
	float a[3], b[3];
	for (int i = 0; i < 3; i++) {
		const Vector2 value = at[0][i] + t * (at[1][i] + t * at[2][i]);
		a[i] = static_cast<float>(value.x());
		b[i] = static_cast<float>(value.y());
	}
	fill_row(a, b, static_cast<float>((begin - middle.x()) / reach), static_cast<float>(1 / reach), count, x, y);
}

} // namespace pong
