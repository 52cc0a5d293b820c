#include "camera_placement.hpp"

#include <Eigen/Dense>

#include "program.hpp"

namespace calibrate
{

namespace
{

using Eigen::Vector3d;

const double along_least = 0.3; // of the viewing direction, along the table

struct Placement {
	Vector3d centre, forward, right; // of the picture
};

Vector3d ray(const pong_camera &camera, double u, double v, Vector3d *centre)
{
	const double uv[2] = {u, v};
	Vector3d direction;
	pong_ray(&camera, uv, centre->data(), direction.data());
	return direction;
}

Placement place(const pong_camera &camera)
{
	const double u = camera.width / 2.0, v = camera.height / 2.0, half = camera.width / 4.0;
	Placement out;
	out.forward = ray(camera, u, v, &out.centre);
	out.right = (ray(camera, u + half, v, &out.centre) - ray(camera, u - half, v, &out.centre)).normalized();
	return out;
}

} // namespace

std::string describe_placement(const pong_camera camera[2])
{
	const Placement left = place(camera[PONG_LEFT]), right = place(camera[PONG_RIGHT]);
	return pong::format("left camera at x %+.3f, y %+.3f, z %+.3f m, the right one %.0f mm from it",
			    left.centre.x(), left.centre.y(), left.centre.z(),
			    1e3 * (right.centre - left.centre).norm());
}

std::string misplaced(const pong_camera camera[2], bool table)
{
	const Placement left = place(camera[PONG_LEFT]), right = place(camera[PONG_RIGHT]);
	if ((right.centre - left.centre).dot(left.right) < 0)
		return "the left pictures are from the camera on the right: are left and right swapped?";
	if (table && left.forward.z() < along_least)
		return pong::format(
			"the cameras look along x %+.1f, y %+.1f, z %+.1f, not along the table (+z): is the "
			"board that tells the frame turned, or are --board's columns and rows exchanged?",
			left.forward.x(), left.forward.y(), left.forward.z());
	return "";
}

} // namespace calibrate
