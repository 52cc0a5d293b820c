// The centre from all of the ball's pixels: a lit sphere of the model in sphere.hpp, blurred by the lens and along its
// streak, is fitted to the picture before the background that the earlier pictures show. The outline's cone is where
// the fit starts; Gauss-Newton steps with robust weights refine it.
//
// The pixels are laid out in a plane across the ray to the ball, in which its outline is a circle wherever in the
// picture it is.
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "locate.hpp"
#include "sphere.hpp"

namespace pong
{

namespace
{

const int pixels_max = 2048;
const int blocks_max = pixels_max / block;
const double outside = 3;       // of the outline, how far pixels are looked at, px
const double step_width = 1.75; // half width of the blurred step to start with, px
const double step_least = 1, step_most = 5;
const double step_prior = 0.5; // standard deviation of that guess, px
const int rounds = 8;
const int plain_rounds = 2;        // without robust weights
const double converged = 0.003;    // px
const double farthest = 0.3;       // of a radius, that the fit may move from its start, and
const double farthest_px = 1;      // px
const float outlier = 3;           // residuals of so many standard deviations count half
const double background_error = 5; // of an earlier picture that shows what is behind the ball, grey levels
const int sectors = 16;
const int first_curved = 8;        // the first parameter of a shading term of second order
const double shading_prior = 1000; // standard deviations of the shading's coefficients, grey levels: of the zeroth and
const double curved_prior = 20;    // first order, and of the second
const double shading_error_part = 0.004; // of a radius: what shading that nine terms can't express does to the centre
const double unexplained_allowed = 0.5;  // of the difference to the background
const double variance_least = 0.05;

// The plane about a ray: pixels of a camera without distortion that looks along it.
struct TangentPlane {
	Matrix3 frame; // rows: the axes of the plane, and the ray, in the camera's frame
	double focal;

	TangentPlane(const Camera &camera, const Vector2 &pixel) : focal(std::sqrt(camera.K(0, 0) * camera.K(1, 1)))
	{
		frame.row(2) = camera.undistort(pixel).homogeneous().normalized();
		frame.row(0) = Vector3::UnitY().cross(frame.row(2)).normalized();
		frame.row(1) = frame.row(2).cross(frame.row(0));
	}

	Vector2 from_pixel(const Camera &camera, const Vector2 &pixel) const
	{
		return focal * (frame * camera.undistort(pixel).homogeneous()).hnormalized();
	}

	Vector2 to_pixel(const Camera &camera, const Vector2 &place) const
	{
		const Vector3 ray = frame.transpose() * Vector3(place.x() / focal, place.y() / focal, 1);
		return camera.distort(ray.hnormalized());
	}
};

// from_pixel near the middle, as a polynomial of the second order: exact at nine pixels.
struct PlaneMap {
	Vector2 middle;
	double reach;
	Eigen::Matrix<double, 2, 9> at; // values at the nine, row by row

	PlaneMap(const TangentPlane &plane, const Camera &camera, const Vector2 &pixel, double around)
		: middle(pixel), reach(around)
	{
		for (int row = -1; row <= 1; row++)
			for (int column = -1; column <= 1; column++)
				at.col(3 * row + column + 4) =
					plane.from_pixel(camera, middle + reach * Vector2(column, row));
	}

	Vector2 operator()(double u, double v) const
	{
		const double x = (u - middle.x()) / reach, y = (v - middle.y()) / reach;
		const Vector3 a(x * (x - 1) / 2, 1 - x * x, x * (x + 1) / 2);
		const Vector3 b(y * (y - 1) / 2, 1 - y * y, y * (y + 1) / 2);
		Vector2 place(0, 0);
		for (int row = 0; row < 3; row++)
			place += b[row] * (at.block<2, 3>(0, 3 * row) * a);
		return place;
	}
};

// The pixels that the fit looks at, in blocks; what fills up the last one has no weight.
struct Pixels {
	int count = 0; // blocks
	SphereBlock blocks[blocks_max];
	float now[blocks_max][block];
	float weight[blocks_max][block]; // 1 / variance, as far as the sensor's noise goes
};

// How a picture's grey level varies: read and rounding noise, and shot noise per grey level, about. Only their relation
// matters: the residuals tell the scale.
float sensor_weight(float level)
{
	const float read = 0.5f, shot = 1.0f / 80;
	return 1 / (read + shot * level);
}

// Where a pixel lies: in the plane, its distance from the way of the centre, and its direction from the middle.
struct Place {
	Vector2 at;
	double distance;
	int sector;
};

class PixelLayout
{
public:
	PixelLayout(const LocateTask &task, const Camera &camera, const TangentPlane &plane, const Vector2 &centre,
		    double radius)
		: task_(task), radius_(radius),
		  map_(plane, camera, centre, radius + outside + task.streak.norm() / 2 + 1),
		  half_way_((map_(centre.x() + task.streak.x() / 2, centre.y() + task.streak.y() / 2) -
			     map_(centre.x() - task.streak.x() / 2, centre.y() - task.streak.y() / 2)) /
			    2)
	{
		const pong_image &image = task.pictures.current;
		const double u = map_.middle.x(), v = map_.middle.y();
		const double reach_u = radius * 1.05 + outside + std::abs(task.streak.x()) / 2;
		const double reach_v = radius * 1.05 + outside + std::abs(task.streak.y()) / 2;
		box_[0] = std::max(0, static_cast<int>(u - reach_u));
		box_[1] = std::min(image.width - 1, static_cast<int>(u + reach_u) + 1);
		box_[2] = std::max(0, static_cast<int>(v - reach_v));
		box_[3] = std::min(image.height - 1, static_cast<int>(v + reach_v) + 1);
		const double area = 4 * reach_u * reach_v;
		step_ = 1 + static_cast<int>(std::sqrt(area / pixels_max));
	}

	Streak streak() const
	{
		const double spacing = 1.2; // px; the blurred step is wider
		const double length = 2 * half_way_.norm();
		Streak streak = {1, {0}, {0}};
		if (length > spacing / 4)
			streak.count = std::min(static_cast<int>(length / spacing) + 2, streak_places_max);
		for (int i = 0; i < streak.count; i++) {
			const double part = (2 * i + 1.0) / streak.count - 1;
			streak.u[i] = static_cast<float>(part * half_way_.x());
			streak.v[i] = static_cast<float>(part * half_way_.y());
		}
		return streak;
	}

	void fill(Pixels *pixels)
	{
		choose_backgrounds();
		int count = 0;
		for_each_place([&](int u, int v, const Place &place) {
			if (place.distance > radius_ + outside || count == pixels_max)
				return;
			SphereBlock &to = pixels->blocks[count / block];
			const int i = count % block;
			const pong_image *background = background_[place.sector];
			const float now = value(task_.pictures.current, u, v);
			to.u[i] = static_cast<float>(place.at.x());
			to.v[i] = static_cast<float>(place.at.y());
			to.background[i] = background ? value(*background, u, v) : now;
			pixels->now[count / block][i] = now;
			const bool known = background || place.distance < radius_ - outside;
			pixels->weight[count / block][i] = known ? sensor_weight(now) : 0;
			count++;
		});
		pixels->count = (count + block - 1) / block;
		for (; count % block; count++) {
			SphereBlock &to = pixels->blocks[count / block];
			const int i = count % block;
			to.u[i] = to.v[i] = to.background[i] = 0;
			pixels->now[count / block][i] = pixels->weight[count / block][i] = 0;
		}
	}

private:
	static float value(const pong_image &image, int u, int v)
	{
		return image.pixels[v * image.stride + u];
	}

	template<class Visit> void for_each_place(Visit visit) const
	{
		const double way2 = half_way_.squaredNorm();
		for (int v = box_[2]; v <= box_[3]; v += step_)
			for (int u = box_[0]; u <= box_[1]; u += step_) {
				Place place = {map_(u, v), 0, 0};
				const double along =
					way2 > 0 ? std::clamp(place.at.dot(half_way_) / way2, -1.0, 1.0) : 0;
				place.distance = (place.at - along * half_way_).norm();
				place.sector = sector_of(place.at);
				visit(u, v, place);
			}
	}

	// 16 of a kind: by signs, by which coordinate is greater, and by half of that.
	static int sector_of(const Vector2 &at)
	{
		const double x = std::abs(at.x()), y = std::abs(at.y());
		const double less = std::min(x, y), more = std::max(x, y);
		return 8 * (at.x() < 0) + 4 * (at.y() < 0) + 2 * (x < y) + (less > 0.41 * more);
	}

	// By direction, the earlier picture that shows just outside of the ball what the current one does.
	void choose_backgrounds()
	{
		double error[2][sectors] = {}, count[sectors] = {};
		for_each_place([&](int u, int v, const Place &place) {
			if (place.distance < radius_ + outside / 2)
				return;
			const float now = value(task_.pictures.current, u, v);
			for (int i = 0; i < 2; i++)
				error[i][place.sector] += std::abs(now - value(task_.pictures.earlier[i], u, v));
			count[place.sector]++;
		});
		for (int sector = 0; sector < sectors; sector++) {
			const int best = error[1][sector] < error[0][sector];
			const bool shows = error[best][sector] <= background_error * count[sector];
			background_[sector] = shows ? &task_.pictures.earlier[best] : nullptr;
		}
	}

	const LocateTask &task_;
	double radius_;
	PlaneMap map_;
	Vector2 half_way_;
	int box_[4]; // u and v, first and last
	int step_;   // of a large ball not every pixel is needed
	const pong_image *background_[sectors];
};

using Parameters = Eigen::Matrix<double, sphere_parameters, 1>;
using Normal = Eigen::Matrix<double, sphere_parameters, sphere_parameters>;

// Gauss-Newton on the pixels.
class SphereFit
{
public:
	SphereFit(Pixels &pixels, const Streak &streak, double radius) : pixels_(pixels), streak_(streak), start_{}
	{
		start_.radius() = static_cast<float>(radius);
		start_.blur() = static_cast<float>(step_width);
		now_ = start_;
	}

	bool run()
	{
		for (int round = 0; round < rounds; round++) {
			accumulate(round >= plain_rounds);
			if (round == 0)
				hold_geometry();
			Parameters step = solver_.compute(normal_).solve(right_);
			if (!step.allFinite())
				return false;
			for (int i = 0; i < sphere_parameters; i++)
				now_.value[i] += static_cast<float>(step[i]);
			now_.blur() = std::clamp<float>(now_.blur(), step_least, step_most);
			const double limit = farthest_px + farthest * start_.radius();
			if (!(std::hypot(now_.u(), now_.v()) < limit) ||
			    !(std::abs(now_.radius() - start_.radius()) < limit))
				return false;
			if (round > plain_rounds && step.head<2>().norm() < converged)
				break;
		}
		return true;
	}

	const SphereParameters &parameters() const
	{
		return now_;
	}

	// Whether the sphere explains most of what tells the ball from its background.
	bool explains() const
	{
		return unexplained_ < unexplained_allowed * different_;
	}

	// Of the centre in the plane.
	Matrix2 covariance() const
	{
		Eigen::Matrix<double, sphere_parameters, 2> unit = Eigen::Matrix<double, sphere_parameters, 2>::Zero();
		unit.topRows<2>().setIdentity();
		return variance_ * solver_.solve(unit).topRows<2>();
	}

private:
	void accumulate(bool robust)
	{
		double normal[sphere_normal_size] = {}, right[sphere_parameters] = {};
		double sum = 0, count = 0;
		unexplained_ = different_ = 0;
		for (int b = 0; b < pixels_.count; b++) {
			render_sphere(now_, streak_, &pixels_.blocks[b]);
			float residual[block], weight[block];
			for (int i = 0; i < block; i++) {
				residual[i] = pixels_.now[b][i] - pixels_.blocks[b].level[i];
				weight[i] = pixels_.weight[b][i];
				const float chi2 = weight[i] * residual[i] * residual[i];
				const float excess = chi2 / (outlier * outlier * static_cast<float>(variance_));
				if (robust)
					weight[i] /= 1 + excess * excess;
				sum += weight[i] * residual[i] * residual[i];
				if (pixels_.weight[b][i] > 0) {
					const float new_level = pixels_.now[b][i] - pixels_.blocks[b].background[i];
					unexplained_ += std::abs(residual[i]);
					different_ += std::abs(new_level);
					count++;
				}
			}
			add_normal_equations(pixels_.blocks[b], weight, residual, normal, right);
		}
		variance_ = std::max(sum / std::max(count - sphere_parameters, 1.0), variance_least);
		const double *in = normal;
		for (int i = 0; i < sphere_parameters; i++) {
			right_[i] = right[i];
			for (int j = i; j < sphere_parameters; j++)
				normal_(i, j) = normal_(j, i) = *in++;
		}
		for (int i = 4; i < sphere_parameters; i++) {
			const double deviation = i < first_curved ? shading_prior : curved_prior;
			const double weight = variance_ / (deviation * deviation);
			normal_(i, i) += weight;
			right_[i] -= weight * now_.value[i];
		}
		normal_(3, 3) += variance_ / (step_prior * step_prior);
		right_[3] += variance_ / (step_prior * step_prior) * (step_width - now_.blur());
	}

	// Before there is shading there is no telling where the ball is.
	void hold_geometry()
	{
		for (int i = 0; i < 4; i++) {
			normal_.row(i).setZero();
			normal_.col(i).setZero();
			normal_(i, i) = 1;
			right_[i] = 0;
		}
	}

	Pixels &pixels_;
	const Streak streak_;
	SphereParameters start_, now_;
	Normal normal_;
	Parameters right_;
	Eigen::LDLT<Normal> solver_;
	double unexplained_ = 0, different_ = 0; // sums of magnitudes, grey levels
	double variance_ = 1;                    // of the residuals, over what the sensor's noise would make it
};

} // namespace

bool locate_photometric(const LocateTask &task, pong_centre *centre)
{
	if (!locate_edges(task, centre))
		return false;
	const Camera camera(task.camera);
	const Vector2 start(centre->u, centre->v);
	const TangentPlane plane(camera, start);
	const double radius = centre->radius * plane.frame.row(2).z();
	PixelLayout layout(task, camera, plane, start, radius);
	Pixels pixels;
	layout.fill(&pixels);
	SphereFit fit(pixels, layout.streak(), radius);
	if (!fit.run())
		return true; // the edges stand
	if (!fit.explains())
		return false;
	SphereParameters found = fit.parameters();
	const Vector2 place(found.u(), found.v());
	const Vector2 uv = plane.to_pixel(camera, place);
	Matrix2 jacobian;
	for (int axis = 0; axis < 2; axis++)
		jacobian.col(axis) = plane.to_pixel(camera, place + Vector2::Unit(axis)) - uv;
	const double shading_error = shading_error_part * radius;
	const Matrix2 covariance = jacobian * fit.covariance() * jacobian.transpose() +
				   shading_error * shading_error * Matrix2::Identity();
	*centre = {uv.x(), uv.y(), found.radius() / plane.frame(2, 2), {}};
	for (int i = 0; i < 2; i++)
		for (int j = 0; j < 2; j++)
			centre->covariance[i][j] = covariance(i, j);
	return true;
}

} // namespace pong
