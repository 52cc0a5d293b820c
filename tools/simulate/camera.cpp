#include "camera.hpp"

#include <cmath>

#include "ball.hpp"
#include "program.hpp"
#include "room.hpp"

namespace sim
{

namespace
{

// x right, y down, z forward, in table axes, for a camera that looks along the table and `pitch` (rad) down.
Eigen::Matrix3d looking_down(double pitch)
{
	Eigen::Matrix3d R;
	R << -1, 0, 0, 0, -std::cos(pitch), -std::sin(pitch), 0, -std::sin(pitch), std::cos(pitch);
	return R;
}

std::string camera_text(const char *side, const char *address, const Camera &camera)
{
	std::string text = pong::format("[%s]\ncamera = \"%s\"\nsize = [%d, %d]\nP = [\n", side, address, camera.width,
					camera.height);
	const Eigen::Matrix<double, 3, 4> P = camera.projection();
	for (int row = 0; row < 3; row++)
		text += pong::format("\t%.17g, %.17g, %.17g, %.17g,\n", P(row, 0), P(row, 1), P(row, 2), P(row, 3));
	const std::array<double, 5> &d = camera.distortion;
	text += pong::format("]\ndistortion = [%.17g, %.17g, %.17g, %.17g, %.17g]\n", d[0], d[1], d[2], d[3], d[4]);
	return text;
}

} // namespace

Eigen::Vector3d Camera::to_camera(const Eigen::Vector3d &point) const
{
	return R_cam_table * (point - centre);
}

bool Camera::project(const Eigen::Vector3d &point, Eigen::Vector2d *uv) const
{
	const Eigen::Vector3d seen = to_camera(point);
	Eigen::Vector2d distorted;
	if (seen.z() <= 0 || !distort(distortion, seen.head<2>() / seen.z(), &distorted))
		return false;
	*uv = focal * distorted + principal;
	return true;
}

Eigen::Vector2d Camera::ideal(const Eigen::Vector2d &uv) const
{
	return undistort(distortion, (uv - principal) / focal);
}

Eigen::Matrix<double, 3, 4> Camera::projection() const
{
	Eigen::Matrix3d K;
	K << focal, 0, principal.x(), 0, focal, principal.y(), 0, 0, 1;
	Eigen::Matrix<double, 3, 4> pose;
	pose << R_cam_table, -R_cam_table * centre;
	return K * pose;
}

bool distort(const std::array<double, 5> &distortion, const Eigen::Vector2d &ideal, Eigen::Vector2d *distorted)
{
	const auto &[k1, k2, p1, p2, k3] = distortion;
	const double x = ideal.x(), y = ideal.y(), r2 = x * x + y * y;
	const double radial = 1 + r2 * (k1 + r2 * (k2 + r2 * k3));
	const double slope = 1 + r2 * (3 * k1 + r2 * (5 * k2 + r2 * 7 * k3)); // d(r radial) / dr
	*distorted = {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
		      y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
	return slope > 0 && radial > 0;
}

Eigen::Vector2d undistort(const std::array<double, 5> &distortion, const Eigen::Vector2d &distorted)
{
	Eigen::Vector2d ideal = distorted;
	for (int i = 0; i < 100; i++) {
		Eigen::Vector2d back;
		distort(distortion, ideal, &back);
		const Eigen::Vector2d error = distorted - back;
		ideal += error;
		if (error.squaredNorm() < 1e-26)
			break;
	}
	return ideal;
}

Rig make_rig(const RigSettings &settings)
{
	Rig rig;
	for (int side = 0; side < 2; side++) {
		Camera &camera = rig[side];
		camera.width = settings.width;
		camera.height = settings.height;
		camera.focal = settings.focal;
		camera.principal = {(settings.width - 1) / 2.0, (settings.height - 1) / 2.0};
		camera.R_cam_table = looking_down(settings.pitch * M_PI / 180);
		camera.centre = {(side == 0 ? 0.5 : -0.5) * settings.baseline, settings.above, -settings.behind};
		camera.distortion = settings.distortion;
	}
	return rig;
}

std::string rig_text(const Rig &rig, double hit_z)
{
	std::string text = "# The simulator's true rig.\n";
	const Coefficients mean;
	text += pong::format("[ball]\ndiameter = %g\nmass = %g\n", 2 * ball_radius, ball_mass);
	text += pong::format("drag = %g\ndrag_by_spin = 0\nmagnus = %g\nmagnus_saturation = 0\n", mean.drag,
			     mean.magnus);
	text += pong::format("restitution = %g\nfriction = %g\ngrip = 0\n\n", mean.restitution, mean.friction);
	text += pong::format("[table]\nlength = %g\nwidth = %g\n\n", table_length, table_width);
	text += pong::format("[hit]\nz = %.17g\n\n", hit_z);
	return text + camera_text("left", "127.0.0.1", rig[0]) + "\n" + camera_text("right", "127.0.0.2", rig[1]);
}

} // namespace sim
