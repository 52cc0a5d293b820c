// The border of a lamp's light on a matt ball, which a polynomial of second order in the normal smooths over.
#pragma once

#include "sphere.hpp"

namespace pong
{

// What a lamp's light has in the fourth order of the surface normal: fourth P4(n . towards), grey levels, P4 the
// Legendre polynomial; normals as in sphere.hpp.
struct Lamp {
	float towards[3];
	float fourth;
};

// The lamp whose light has a shade's second order.
Lamp lamp_of(const float shade[shading_terms]);

// What it adds to pixels that render_sphere has filled.
void render_lamp(const Lamp &lamp, const SphereBlock &pixels, float level[block]);

} // namespace pong
