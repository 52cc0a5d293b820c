// The light on a ball, which both cameras see alike.
#pragma once

#include "camera.hpp"
#include "sphere.hpp"

namespace pong
{

using LightMatrix = Eigen::Matrix<double, shading_terms, shading_terms>;

// The shading terms (sphere.hpp) in a frame in which a normal n is `turn` n, from those where it is n.
LightMatrix turn_light(const Matrix3 &turn);

// What a fit finds of a ball, in this order: u, v, the shading terms in the table frame, the radius (px).
const int centre_terms = 2;
const int found_terms = centre_terms + PONG_LIGHT_TERMS;
using FoundVector = Eigen::Matrix<double, found_terms, 1>;
using FoundMatrix = Eigen::Matrix<double, found_terms, found_terms>;

// Keep the light of a fit, and how its errors go with the centre's.
void store_light(const FoundVector &found, const FoundMatrix &covariance, pong_light *light);

// One light for both pictures of a ball at a position: what each centre's own light errs by, the centre errs with.
// Moves both centres, and gives the covariance of left u, v, right u, v. False where the fits told no light.
bool join_lights(const pong_camera camera[2], const Vector3 &position, pong_centre centre[2],
		 Eigen::Matrix4d *covariance);

} // namespace pong
