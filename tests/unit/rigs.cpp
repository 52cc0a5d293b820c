#include "rigs.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace
{

// P = K R [I | -c] written out: image right is -x, image down is -y tilted, forward is +z tilted.
pong_camera test_camera(double x)
{
	const double f = 1081, cu = 319.5, cv = 239.5, pitch = 13 * M_PI / 180;
	const double centre[3] = {x, 0.5, -0.4};
	const double right[3] = {-1, 0, 0};
	const double down[3] = {0, -std::cos(pitch), -std::sin(pitch)};
	const double forward[3] = {0, -std::sin(pitch), std::cos(pitch)};
	pong_camera camera = {};
	camera.width = 640;
	camera.height = 480;
	for (int i = 0; i < 3; i++) {
		camera.P[0][i] = f * right[i] + cu * forward[i];
		camera.P[1][i] = f * down[i] + cv * forward[i];
		camera.P[2][i] = forward[i];
	}
	for (auto &row : camera.P)
		row[3] = -(row[0] * centre[0] + row[1] * centre[1] + row[2] * centre[2]);
	return camera;
}

} // namespace

pong_rig test_rig()
{
	pong_rig rig = {};
	pong_rig_defaults(&rig);
	rig.camera[PONG_LEFT] = test_camera(0.09);
	rig.camera[PONG_RIGHT] = test_camera(-0.09);
	return rig;
}
