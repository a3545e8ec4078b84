#pragma once

// Light of wavefronts on a plane, as a map to compare with counted photons.
#include "lab/ball_photons.h"

#include <pellucid/volume_light.h>

#include <span>
#include <vector>

namespace pellucid {

/// Sets the map of `plane` to a level square around (0, height, 0), with texels of about `texel` m.
void set_level_map(BallAndPlane& plane, double half_edge, double height, double texel);

/// Irradiance of every texel of the plane's map, W/m2, for one colour (0 to 2). Each photon is spread over its disc,
/// as in look-ups.
std::vector<double> landed_map(std::span<const LandedPhoton> photons, const BallAndPlane& plane, int color = 0);

}  // namespace pellucid
