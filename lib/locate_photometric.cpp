// The centre from all of the ball's pixels: a lit sphere of the model in sphere.hpp, blurred by the lens and along its
// streak, is fitted to the picture before the background that the earlier pictures show. The outline's cone is where
// the fit starts; Gauss-Newton steps with robust weights refine it.
#include <algorithm>
#include <cmath>

#include "ball_pixels.hpp"
#include "lamp.hpp"
#include "light.hpp"

namespace pong
{

namespace
{

const double blur_usual = 0.65; // standard deviation of the blurred step, px: lens and pixel
const double blur_least = 0.35, blur_most = 2;
const double blur_prior = 0.2; // standard deviation of that guess, px
const int rounds = 8;
const int plain_rounds = 2;    // without robust weights
const double converged = 0.01; // px
const double farthest = 0.3;   // of a radius, that the fit may move from its start, and
const double farthest_px = 1;  // px
const float outlier = 3;       // residuals of so many standard deviations count half
const int radius_parameter = 2;
const int first_curved = geometry_terms + 4; // the first parameter of a shading term of second order
// Standard deviations of the shading's coefficients, grey levels: of the zeroth and first order; and of the second,
// which is less where the first is small.
const double shading_prior = 1000;
const double curved_prior = 8, curved_prior_part = 0.15;
const double background_prior = 0.15; // standard deviation of the background's factor and of its slopes
// The covariance's parts, by which the normalised squared errors average 2 (docs/locate.md): of the fit's own, which
// holds for a true model; of the patches'; and of the last step's square.
const double noise_part = 2.1, patch_part = 0.4, step_part = 2;
const double streak_error_part = 0.005; // of a streak, along it: the velocity is not known exactly
const int lamp_rounds = 2;
const double kept_least = 0.5;          // of a sector's outline, by the robust weights, where nothing covers it
const int covered_least = 3;            // sectors of a ball that something covers
const double covered_factor = 4;        // of the covariance then
const double unexplained_allowed = 0.5; // of the difference to the background
const double variance_least = 0.05;

using Parameters = Eigen::Matrix<double, sphere_parameters, 1>;
using Normal = Eigen::Matrix<double, sphere_parameters, sphere_parameters>;

// The way of the ball as places less than a blur apart, from -half to half about the ray to its middle. Where it comes
// nearer, both its distance from that ray and its radius grow like 1 / depth.
Streak make_streak(const Vector2 &half, double growth)
{
	const double spacing = 1.5; // px; the blurred step is wider
	const double length = 2 * half.norm();
	Streak streak = {};
	streak.count = 1;
	if (length > spacing / 4)
		streak.count = std::min(static_cast<int>(length / spacing) + 2, streak_places_max);
	for (int i = 0; i < streak.count; i++) {
		const double part = (2 * i + 1.0) / streak.count - 1;
		const double size = 1 / (1 - part * growth / 2);
		streak.u[i] = static_cast<float>(part * size * half.x());
		streak.v[i] = static_cast<float>(part * size * half.y());
		streak.size[i] = static_cast<float>(size);
	}
	return streak;
}

// Gauss-Newton on the pixels.
class SphereFit
{
public:
	SphereFit(BallPixels &pixels, const Streak &streak, double radius, double limit)
		: pixels_(pixels), streak_(streak), limit_(limit), start_{}
	{
		start_.radius() = static_cast<float>(radius);
		start_.blur() = static_cast<float>(blur_usual);
		now_ = start_;
	}

	bool run()
	{
		for (int round = 0; round < rounds; round++) {
			accumulate(round >= plain_rounds);
			if (round == 0)
				hold_geometry();
			const Parameters step = solver_.compute(normal_).solve(right_);
			if (!step.allFinite())
				return false;
			for (int i = 0; i < sphere_parameters; i++)
				now_.value[i] += static_cast<float>(step[i]);
			now_.blur() = std::clamp<float>(now_.blur(), blur_least, blur_most);
			if (!(std::hypot(now_.u(), now_.v()) < limit_) ||
			    !(std::abs(now_.radius() - start_.radius()) < limit_))
				return false;
			last_step_ = step.head<2>();
			if (round > plain_rounds && last_step_.norm() < converged)
				break;
		}
		return true;
	}

	// The border of a lamp's light (lamp.hpp): by how much it has moved the fit, to the first order, the fit moves
	// back. That changes the second order, which tells the lamp.
	void add_lamp()
	{
		const SphereParameters without = now_;
		for (int round = 0; round < lamp_rounds; round++) {
			const Lamp lamp = lamp_of(now_.value + geometry_terms);
			NormalEquations sums;
			sums.clear();
			for (int b = 0; b < pixels_.count; b++) {
				render_lamp(lamp, pixels_.blocks[b], lamp_level_[b]);
				sums.add_right(pixels_.blocks[b], kept_[b], lamp_level_[b]);
			}
			Parameters pull;
			for (int i = 0; i < sphere_parameters; i++)
				pull[i] = add_up(sums.right[i]);
			const Parameters change = -solver_.solve(pull);
			for (int i = 0; i < sphere_parameters; i++)
				now_.value[i] = without.value[i] + static_cast<float>(change[i]);
		}
		update_residuals(without);
	}

	// In the plane.
	FoundVector found() const
	{
		FoundVector out;
		for (int i = 0; i < found_terms; i++)
			out[i] = static_cast<double>(now_.value[parameter_of(i)]);
		return out;
	}

	// Whether the sphere explains most of what tells the ball from its background.
	bool explains() const
	{
		return unexplained_ < unexplained_allowed * different_;
	}

	// Of what is found, in the plane. Were the model true, the first part would do. What it cannot express shows in
	// residuals that neighbours share: the second part takes them as alike within a patch. Where the steps
	// shrink slowly, more are missing like the last one.
	FoundMatrix covariance() const
	{
		float pull[patches][sphere_parameters] = {};
		for (int b = 0; b < pixels_.count; b++) {
			float weighted[block];
			for (int i = 0; i < block; i++)
				weighted[i] = kept_[b][i] * residual_[b][i];
			for (int i = 0; i < block; i++)
				for (int k = 0; k < sphere_parameters; k++)
					pull[pixels_.patch[b][i]][k] += weighted[i] * pixels_.blocks[b].slope[k][i];
		}
		const Eigen::Matrix<double, sphere_parameters, found_terms> columns = uncertainty();
		FoundMatrix fit;
		for (int i = 0; i < found_terms; i++)
			fit.row(i) = columns.row(parameter_of(i));
		const auto pulls =
			Eigen::Map<Eigen::Matrix<float, patches, sphere_parameters, Eigen::RowMajor>>(&pull[0][0]);
		const Eigen::Matrix<double, patches, found_terms> moved = pulls.cast<double>() * columns;
		FoundMatrix out = noise_part * variance_ * fit + patch_part * moved.transpose() * moved;
		out.topLeftCorner<2, 2>() += step_part * last_step_ * last_step_.transpose();
		return out;
	}

	// Whether at some of the outline the picture is not at all what a ball would make it.
	bool covered() const
	{
		double kept[sectors] = {}, all[sectors] = {};
		for (int b = 0; b < pixels_.count; b++)
			for (int i = 0; i < block; i++) {
				const int sector = pixels_.patch[b][i] - sectors;
				if (sector < 0)
					continue;
				// Beside the ball a thing that covers it looks as it did before.
				const float cover = pixels_.blocks[b].slope[geometry_terms][i];
				kept[sector] += static_cast<double>(cover * kept_[b][i]);
				all[sector] += static_cast<double>(cover * pixels_.weight[b][i]);
			}
		int count = 0;
		for (int sector = 0; sector < sectors; sector++)
			count += all[sector] > 0 && kept[sector] < kept_least * all[sector];
		return count >= covered_least;
	}

private:
	// Which of the fit's parameters a term of what is found is.
	static int parameter_of(int term)
	{
		return term < centre_terms ? term : term == found_terms - 1 ? radius_parameter : term + 2;
	}

	// The columns of the normal matrix's inverse that belong to what is found.
	Eigen::Matrix<double, sphere_parameters, found_terms> uncertainty() const
	{
		Eigen::Matrix<double, sphere_parameters, found_terms> unit;
		for (int i = 0; i < found_terms; i++)
			unit.col(i) = Parameters::Unit(parameter_of(i));
		return solver_.solve(unit);
	}

	void accumulate(bool robust)
	{
		NormalEquations sums;
		sums.clear();
		float sum = 0, unexplained = 0, different = 0, count = 0;
		const float per_excess = 1 / (outlier * outlier * static_cast<float>(variance_));
		const float per_unit = 1 / start_.radius();
		for (int b = 0; b < pixels_.count; b++) {
			render_sphere(now_, streak_, per_unit, &pixels_.blocks[b]);
			float *residual = residual_[b], *weight = kept_[b];
			for (int i = 0; i < block; i++) {
				residual[i] = pixels_.now[b][i] - pixels_.blocks[b].level[i];
				weight[i] = pixels_.weight[b][i];
				const float excess = weight[i] * residual[i] * residual[i] * per_excess;
				const float known = weight[i] > 0;
				if (robust)
					weight[i] /= 1 + excess * excess;
				sum += weight[i] * residual[i] * residual[i];
				unexplained += known * std::abs(residual[i]);
				different += known * std::abs(pixels_.now[b][i] - pixels_.blocks[b].background[i]);
				count += known;
			}
			sums.add(pixels_.blocks[b], weight, residual);
		}
		unexplained_ = unexplained;
		different_ = different;
		set_variance(sum, count);
		take(sums);
		add_priors();
	}

	// After the lamp has been added, and the parameters have changed.
	void update_residuals(const SphereParameters &before)
	{
		float change[sphere_parameters], sum = 0, count = 0;
		for (int k = 0; k < sphere_parameters; k++)
			change[k] = now_.value[k] - before.value[k];
		for (int b = 0; b < pixels_.count; b++) {
			float *residual = residual_[b];
			for (int i = 0; i < block; i++)
				residual[i] -= lamp_level_[b][i];
			change_residual(pixels_.blocks[b], change, residual);
			for (int i = 0; i < block; i++) {
				sum += kept_[b][i] * residual[i] * residual[i];
				count += pixels_.weight[b][i] > 0;
			}
		}
		set_variance(sum, count);
	}

	void set_variance(float sum, float count)
	{
		variance_ = std::max<double>(sum / std::max(count - sphere_parameters, 1.0f), variance_least);
	}

	static double add_up(const float lane[NormalEquations::lanes])
	{
		double sum = 0;
		for (int i = 0; i < NormalEquations::lanes; i++)
			sum += static_cast<double>(lane[i]);
		return sum;
	}

	void take(const NormalEquations &sums)
	{
		const float(*in)[NormalEquations::lanes] = sums.normal;
		for (int i = 0; i < sphere_parameters; i++) {
			right_[i] = add_up(sums.right[i]);
			for (int j = i; j < sphere_parameters; j++)
				normal_(i, j) = normal_(j, i) = add_up(*in++);
		}
	}

	void add_priors()
	{
		const auto add = [&](int i, double usual, double deviation) {
			const double weight = variance_ / (deviation * deviation);
			normal_(i, i) += weight;
			right_[i] += weight * (usual - static_cast<double>(now_.value[i]));
		};
		add(geometry_terms - 1, blur_usual, blur_prior);
		const float *rise = now_.value + geometry_terms + 1;
		const double curved = curved_prior + curved_prior_part * std::hypot(rise[0], rise[1], rise[2]);
		for (int i = geometry_terms; i < first_background; i++)
			add(i, 0, i < first_curved ? shading_prior : curved);
		for (int i = first_background; i < sphere_parameters; i++)
			add(i, 0, background_prior);
	}

	// Before there is shading there is no telling where the ball is.
	void hold_geometry()
	{
		for (int i = 0; i < geometry_terms; i++) {
			normal_.row(i).setZero();
			normal_.col(i).setZero();
			normal_(i, i) = 1;
			right_[i] = 0;
		}
	}

	BallPixels &pixels_;
	const Streak streak_;
	const double limit_; // how far centre and radius may move, px
	SphereParameters start_, now_;
	Normal normal_;
	Parameters right_;
	Eigen::LDLT<Normal> solver_;
	Vector2 last_step_ = {0, 0};                                  // px
	float residual_[blocks_max][block], kept_[blocks_max][block]; // grey levels, and their robust weights
	float lamp_level_[blocks_max][block];                         // grey levels
	double unexplained_ = 0, different_ = 0;                      // sums of magnitudes, grey levels
	double variance_ = 1; // of the residuals, over what the sensor's noise would make it
};

// What is found in the plane at a place there, to the picture and the table frame.
FoundMatrix pixels_from_plane(const Camera &camera, const TangentPlane &plane, const Vector2 &at)
{
	FoundMatrix out = FoundMatrix::Zero();
	const Vector2 uv = plane.to_pixel(camera, at);
	for (int axis = 0; axis < 2; axis++)
		out.col(axis).head<2>() = plane.to_pixel(camera, at + Vector2::Unit(axis)) - uv;
	// A normal's third part is towards the camera, the plane's third axis away from it.
	const Matrix3 turn = camera.R.transpose() * plane.frame.transpose() * Vector3(1, 1, -1).asDiagonal();
	out.block<shading_terms, shading_terms>(centre_terms, centre_terms) = turn_light(turn);
	out(found_terms - 1, found_terms - 1) = 1 / plane.frame(2, 2);
	return out;
}

} // namespace

bool locate_photometric(const LocateTask &task, pong_centre *centre)
{
	if (!locate_edges(task, centre))
		return false;
	const Camera camera(task.camera);
	const Vector2 start(centre->u, centre->v);
	const TangentPlane plane(camera, start);
	const double streak = task.streak.norm();
	const double radius = centre->radius * plane.frame(2, 2);
	const PlaneMap map(plane, camera, start, 1.05 * radius + streak / 2 + 5);
	const BallPlace place = {start, radius, (map(start + task.streak / 2) - map(start - task.streak / 2)) / 2};
	BallPixels pixels;
	choose_pixels(task, map, place, &pixels);
	SphereFit fit(pixels, make_streak(place.half, task.growth), radius, farthest_px + farthest * (radius + streak));
	if (!fit.run())
		return true; // the edges stand
	if (!fit.explains())
		return false;
	const bool covered = fit.covered();
	fit.add_lamp();
	FoundVector found = fit.found();
	const FoundMatrix to_pixels = pixels_from_plane(camera, plane, found.head<2>());
	const Vector2 uv = plane.to_pixel(camera, found.head<2>());
	found = to_pixels * found;
	FoundMatrix covariance = (covered ? covered_factor : 1) * to_pixels * fit.covariance() * to_pixels.transpose();
	covariance.topLeftCorner<2, 2>() +=
		streak_error_part * streak_error_part * task.streak * task.streak.transpose();
	*centre = make_centre(uv, found[found_terms - 1], covariance.topLeftCorner<2, 2>());
	centre->common = common_part;
	centre->flags = (pixels.cut ? PONG_CENTRE_CUT : 0) | (covered ? PONG_CENTRE_COVERED : 0);
	store_light(found, covariance, &centre->light);
	return true;
}

} // namespace pong
