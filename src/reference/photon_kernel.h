#pragma once

#include "reference/camera_rays.h"
#include "reference/geometry.h"
#include "reference/photon_map.h"

#include <cstdint>
#include <vector>

namespace pellucid::reference {

/// Sets the look-up disc of every photon, of `radius`, m, and the receiver's area inside the disc. At an edge or at
/// the foot of a wall the photon's flux thus stays on the receiver. The radius is at least a quarter of a pixel at the
/// photon's position, because an image resolves no finer.
void spread_over_receivers(const Geometry& geometry, const CameraRays& rays, double radius, std::uint32_t seed,
                           std::vector<Photon>& photons);

}  // namespace pellucid::reference
