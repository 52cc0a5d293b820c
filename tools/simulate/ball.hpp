// The ball's physics: flight with drag, Magnus force, gravity and buoyancy; bounce with friction.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace sim
{

constexpr double ball_radius = 0.020; // m
constexpr double ball_mass = 0.0027;  // kg

struct Ball {
	Eigen::Vector3d position = Eigen::Vector3d::Zero(); // of the centre, m
	Eigen::Vector3d velocity = Eigen::Vector3d::Zero(); // m/s
	Eigen::Vector3d spin = Eigen::Vector3d::Zero();     // rad/s
	Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

// What differs from ball to ball and from table to table.
struct Coefficients {
	double drag = 0.47;        // C in F = C rho S v^2 / 2
	double magnus = 4.65e-6;   // F = magnus * spin x velocity, kg
	double restitution = 0.93; // vertical speed after a bounce over the one before
	double friction = 0.25;    // mu between ball and table
};

// Acceleration in the air, m/s^2. Spin does not decay: over a flight of half a second it hardly does.
Eigen::Vector3d acceleration(const Coefficients &coefficients, const Eigen::Vector3d &velocity,
			     const Eigen::Vector3d &spin);

// The ball `seconds` later in the air: one Runge-Kutta step of fourth order.
Ball fly(const Coefficients &coefficients, const Ball &ball, double seconds);

// The ball right after it has touched the table from above (Nakashima et al. 2010): friction stops the slip of the
// contact point where it can, and the ball then rolls; else it slides throughout.
Ball bounce(const Coefficients &coefficients, const Ball &ball);

} // namespace sim
