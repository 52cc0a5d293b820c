#include "closer.hpp"

#include <algorithm>
#include <cmath>

#include "camera.hpp"

namespace pong
{

namespace
{

const int anchors_most = 6;           // of each camera
const double anchor_shown = 0.8;      // of its outline
const double same_anchor = 0.5;       // centres so near to each other are one ball's, found twice, px
const double fresh_enough = 12;       // grey levels
const double depth_range = 0.08;      // the distance that a radius tells is known as well as that
const int samples_most = 40;          // along the epipolar line
const double coarse = 1, fine = 0.25; // from one to the next, px

void look_where_expected(const pong_rig &rig, Side *const side[2], const double expected[3])
{
	for (int i = 0; i < 2; i++) {
		const pong_camera &camera = rig.camera[i];
		double uv[2];
		if (pong_project(&camera, expected, uv))
			side[i]->look_near(uv[0], uv[1], pong_apparent_size(&camera, expected, rig.ball.diameter));
	}
}

struct Range {
	double least, most;
};

// A ball on the ray that one camera sees it on, as the other camera sees it.
class OtherView
{
public:
	OtherView(const pong_rig &rig, int anchored, const pong_centre &centre)
		: rig_(rig), other_(rig.camera[1 - anchored])
	{
		const double uv[2] = {centre.u, centre.v};
		pong_ray(&rig.camera[anchored], uv, origin_, direction_);
		// Its size goes as one over the distance.
		double at_one[3];
		position(1, at_one);
		distance_ = pong_apparent_size(&rig.camera[anchored], at_one, rig.ball.diameter) / (2 * centre.radius);
	}

	// How many times the distance that its radius tells it can be away.
	Range range(const Expected *expected) const
	{
		const Range by_radius = {1 - depth_range, 1 + depth_range};
		if (!expected)
			return by_radius;
		const double *at = expected->state.position;
		const double away = std::hypot(at[0] - origin_[0], at[1] - origin_[1], at[2] - origin_[2]);
		return {std::max(by_radius.least, (away - expected->reach) / distance_),
			std::min(by_radius.most, (away + expected->reach) / distance_)};
	}

	// At so many times the distance that its radius tells.
	bool place(double factor, pong_detection *place) const
	{
		double at[3], uv[2];
		position(factor * distance_, at);
		if (!pong_project(&other_, at, uv))
			return false;
		*place = {uv[0], uv[1], pong_apparent_size(&other_, at, rig_.ball.diameter), 0};
		return true;
	}

private:
	void position(double distance, double at[3]) const
	{
		for (int axis = 0; axis < 3; axis++)
			at[axis] = origin_[axis] + distance * direction_[axis];
	}

	const pong_rig &rig_;
	const pong_camera &other_;
	double origin_[3], direction_[3], distance_;
};

// Where in that range the other camera shows the strongest outline, in steps of so many px.
bool strongest(const OtherView &view, const Side &other, const Range &range, double step, double *factor,
	       pong_detection *found)
{
	pong_detection ends[2];
	if (!(range.least < range.most) || !view.place(range.least, &ends[0]) || !view.place(range.most, &ends[1]))
		return false;
	const double length = std::hypot(ends[1].u - ends[0].u, ends[1].v - ends[0].v);
	const int count = std::min(static_cast<int>(length / step) + 2, samples_most);
	double best = 0;
	for (int i = 0; i < count; i++) {
		const double part = range.least + (range.most - range.least) * i / (count - 1);
		pong_detection place;
		if (!view.place(part, &place))
			continue;
		const Outline outline = other.outline(place.u, place.v, place.size / 2);
		if (!(outline.shown * outline.step > best))
			continue;
		best = outline.shown * outline.step;
		*factor = part;
		*found = place;
		found->contrast = outline.step;
	}
	return best > 0;
}

// The balls of one camera that were looked for in the other one.
class Anchors
{
public:
	bool full() const
	{
		return count_ == anchors_most;
	}

	// The same ball is found before one background and before another.
	bool has(const pong_centre &centre) const
	{
		return std::any_of(centre_, centre_ + count_, [&](const pong_centre *other) {
			return std::hypot(other->u - centre.u, other->v - centre.v) < same_anchor;
		});
	}

	void add(const pong_centre &centre)
	{
		centre_[count_++] = &centre;
	}

private:
	const pong_centre *centre_[anchors_most];
	int count_ = 0;
};

bool is_fresh(const Side &side, double u, double v, double radius)
{
	return side.freshness(u, v, radius) > fresh_enough;
}

void look_at_anchor(const OtherView &view, const Range &range, bool followed, Side &other)
{
	double factor;
	pong_detection place;
	if (!strongest(view, other, range, coarse, &factor, &place))
		return;
	const double around = (range.most - range.least) / 8;
	const Range near = {std::max(range.least, factor - around), std::min(range.most, factor + around)};
	if (strongest(view, other, near, fine, &factor, &place) &&
	    (followed || is_fresh(other, place.u, place.v, place.size / 2)))
		other.look_at(place);
}

} // namespace

void look_closer(const pong_rig &rig, Side &left, Side &right, const Expected *expected, bool followed)
{
	Side *side[2] = {&left, &right};
	if (expected)
		look_where_expected(rig, side, expected->state.position);
	const int count[2] = {left.count(), right.count()};
	for (int anchored = 0; anchored < 2; anchored++) {
		Anchors anchors;
		for (int i = 0; i < count[anchored] && !anchors.full(); i++) {
			const Side::Ball *ball = side[anchored]->ball(i);
			if (!ball || ball->shown < anchor_shown || anchors.has(ball->centre) ||
			    !(followed ||
			      is_fresh(*side[anchored], ball->centre.u, ball->centre.v, ball->centre.radius)))
				continue;
			const OtherView view(rig, anchored, ball->centre);
			look_at_anchor(view, view.range(expected), followed, *side[1 - anchored]);
			anchors.add(ball->centre);
		}
	}
}

} // namespace pong
