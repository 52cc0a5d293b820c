#include "board.hpp"

#include <cmath>
#include <random>

#include <Eigen/Geometry>

#include "texture.hpp"

namespace sim
{

namespace
{

constexpr double white = 205, black = 28; // grey levels
constexpr double margin = 1.6;            // of paper around the inner corners: a square and some white, squares

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Facing the cameras upright: x to their right, y down, z away.
Matrix3d upright()
{
	return Vector3d(-1, -1, 1).asDiagonal();
}

// On the table, seen from the robot: x to the right, y towards the robot, z into the table.
Matrix3d lying()
{
	Matrix3d R;
	R << -1, 0, 0, 0, 0, -1, 0, -1, 0;
	return R;
}

BoardPose centred(const BoardSettings &settings, const Matrix3d &R_table_board, const Vector3d &middle)
{
	const Vector3d half((settings.columns - 1) * settings.square / 2, (settings.rows - 1) * settings.square / 2, 0);
	return {R_table_board, middle - R_table_board * half, NAN};
}

bool in_view(const BoardSettings &settings, const BoardPose &pose, const Rig &rig)
{
	for (const Camera &camera : rig)
		for (const Vector3d &corner : outline(settings, pose)) {
			Eigen::Vector2d uv;
			if (!camera.project(corner, &uv) || uv.minCoeff() < 2 || uv.x() > camera.width - 3 ||
			    uv.y() > camera.height - 3)
				return false;
		}
	return true;
}

// Seen from between the cameras: the direction of a picture's point (u, v from -1 to 1).
Vector3d direction(const Rig &rig, double u, double v)
{
	const Camera &camera = rig[0];
	const Vector3d ray(u * camera.width / 2 / camera.focal, v * camera.height / 2 / camera.focal, 1);
	return camera.R_cam_table.transpose() * ray;
}

BoardPose draw_tilted(const BoardSettings &settings, const Rig &rig, std::mt19937_64 &random)
{
	std::uniform_real_distribution<double> unit(-1, 1);
	const Vector3d between = (rig[0].centre + rig[1].centre) / 2;
	const double size = settings.square * (std::max(settings.columns, settings.rows) + 1);
	BoardPose pose = {};
	for (int attempt = 0; attempt < 2000; attempt++) {
		// Near enough to fill a good part of the picture; a try that is not in view steps back a little.
		const double depth = size * rig[0].focal / rig[0].width * (1.9 + 0.7 * unit(random)) + attempt * 0.002;
		const double tilt = (30 + 12 * unit(random)) * M_PI / 180, about = M_PI * unit(random);
		const double roll = 15 * M_PI / 180 * unit(random);
		const Matrix3d turned = (Eigen::AngleAxisd(tilt, Vector3d(std::cos(about), std::sin(about), 0)) *
					 Eigen::AngleAxisd(roll, Vector3d::UnitZ()))
						.toRotationMatrix();
		const Vector3d middle = between + depth * direction(rig, 0.6 * unit(random), 0.6 * unit(random));
		pose = centred(settings, rig[0].R_cam_table.transpose() * turned, middle);
		if (in_view(settings, pose, rig))
			break;
	}
	return pose;
}

// High enough to be seen at the nearest and at the farthest plane.
double height_of_planes(const BoardSettings &settings, const Rig &rig)
{
	if (std::isfinite(settings.plane_y))
		return settings.plane_y;
	double y = 0;
	for (const double plane : settings.planes) {
		const Vector3d axis = direction(rig, 0, 0);
		y += (rig[0].centre.y() + (plane - rig[0].centre.z()) * axis.y() / axis.z()) /
		     static_cast<double>(settings.planes.size());
	}
	return y;
}

// Moved along z as on rails: x and y stay.
BoardPose at_plane(const BoardSettings &settings, const Rig &rig, double z)
{
	BoardPose pose = centred(settings, upright(), {0, height_of_planes(settings, rig), z});
	pose.plane_z = z;
	return pose;
}

// Where people put a board that they meant to put at `pose`: moved, and turned about its middle.
BoardPose misplaced(const BoardSettings &settings, const BoardPose &pose, std::mt19937_64 &random)
{
	if (settings.misplaced == 0 && settings.misturned == 0)
		return pose;
	std::normal_distribution<double> normal(0, 1);
	const auto draw = [&](double sigma) {
		const double x = normal(random), y = normal(random), z = normal(random);
		return Vector3d(sigma * Vector3d(x, y, z));
	};
	const Vector3d shift = draw(settings.misplaced), turn = draw(settings.misturned);
	const Vector3d half((settings.columns - 1) * settings.square / 2, (settings.rows - 1) * settings.square / 2, 0);
	const Vector3d middle = pose.origin + pose.R_table_board * half;
	Matrix3d R = pose.R_table_board;
	if (turn.norm() > 0)
		R = Eigen::AngleAxisd(turn.norm(), turn.normalized()) * R;
	BoardPose result = centred(settings, R, middle + shift);
	result.plane_z = pose.plane_z;
	return result;
}

} // namespace

std::vector<BoardPose> draw_poses(const BoardSettings &settings, const Rig &rig, uint64_t seed)
{
	// Errors of placement have a generator of their own, so that they change no other pose.
	std::mt19937_64 random(hash(seed + 77)), errors(hash(seed + 78));
	BoardPose flat = centred(settings, lying(), {0, 0, 0.6});
	for (int i = 0; i < 200 && !in_view(settings, flat, rig); i++)
		flat.origin.z() += 0.01;
	std::vector<BoardPose> poses = {misplaced(settings, flat, errors)};
	const size_t tilted = static_cast<size_t>(settings.tilted);
	for (size_t i = 0; i < std::max(settings.planes.size(), tilted); i++) {
		if (i < settings.planes.size())
			poses.push_back(misplaced(settings, at_plane(settings, rig, settings.planes[i]), errors));
		if (i < tilted)
			poses.push_back(draw_tilted(settings, rig, random));
	}
	return poses;
}

std::vector<Vector3d> outline(const BoardSettings &settings, const BoardPose &pose)
{
	std::vector<Vector3d> corners;
	for (const double x : {-margin, settings.columns - 1 + margin})
		for (const double y : {-margin, settings.rows - 1 + margin})
			corners.push_back(pose.origin + pose.R_table_board * settings.square * Vector3d(x, y, 0));
	return corners;
}

bool look_at_board(const BoardSettings &settings, const BoardPose &pose, const Ray &ray, double *level)
{
	const Vector3d normal = pose.R_table_board.col(2);
	const double t = normal.dot(pose.origin - ray.origin) / normal.dot(ray.direction);
	const Vector3d on_board =
		pose.R_table_board.transpose() * (ray.origin + t * ray.direction - pose.origin) / settings.square;
	const double x = on_board.x(), y = on_board.y();
	if (!(t > 0) || x < -margin || y < -margin || x > settings.columns - 1 + margin ||
	    y > settings.rows - 1 + margin)
		return false;
	const bool in_squares = x >= -1 && y >= -1 && x < settings.columns && y < settings.rows;
	const bool odd = (static_cast<int>(std::floor(x)) + static_cast<int>(std::floor(y))) & 1;
	// Lit from above: a board that leans back is brighter.
	const double light = 0.85 - 0.15 * normal.y();
	*level = light * (in_squares && !odd ? black : white);
	return true;
}

} // namespace sim
