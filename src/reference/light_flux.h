#pragma once

#include "reference/path_walk.h"

#include <pellucid/reference.h>

#include <cstdint>
#include <vector>

namespace pellucid::reference {

/// Implementation of Tracer::light_flux.
std::vector<LightFlux> light_flux(const Geometry& geometry, const CurvedVolumes& volumes, const Scene& scene,
                                  std::uint32_t photons, std::uint32_t seed, std::uint32_t threads);

}  // namespace pellucid::reference
