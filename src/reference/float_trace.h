#pragma once

#include "reference/geometry.h"

#include <pellucid/reference.h>

#include <glm/glm.hpp>

#include <cstdint>
#include <span>

namespace pellucid::reference {

/// Tracer::trace_fast. A plain loop over Embree's rays or packets of settings.packet rays in step.
///
/// - A path does not meet the surface that it stands on because its search begins a little ahead of it, in
///   proportion to the coordinates: closer surfaces (the tip of a wedge) are missed.
/// - It keeps the solid that it is in and the one around that, no more.
/// Throws Error for settings, a camera or a buffer out of range. `threads` 0: all cores.
void trace_float(const Geometry& geometry, const Camera& camera, const ExactSettings& settings, std::uint32_t threads,
                 std::span<glm::vec3> directions);

}  // namespace pellucid::reference
