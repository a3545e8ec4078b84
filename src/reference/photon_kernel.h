#pragma once

#include "reference/camera_rays.h"
#include "reference/geometry.h"
#include "reference/photon_map.h"

#include <cstdint>
#include <vector>

namespace pellucid::reference {

/// Gives every photon the disc over which look-ups find it, of `radius`, m, and the area of its receiver that the disc
/// covers: at an edge, or at the foot of a wall, a photon's flux stays on the receiver. The radius is at least a quarter
/// of a pixel, as wide as that is where the photon lies; finer than that no picture shows.
void spread_over_receivers(const Geometry& geometry, const CameraRays& rays, double radius, std::uint32_t seed,
                           std::vector<Photon>& photons);

}  // namespace pellucid::reference
