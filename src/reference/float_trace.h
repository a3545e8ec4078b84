#pragma once

#include "reference/geometry.h"

#include <pellucid/reference.h>

#include <glm/glm.hpp>

#include <cstdint>
#include <span>

namespace pellucid::reference {

/// Implementation of Tracer::trace_fast: a plain loop over Embree's rays or packets of settings.packet rays in
/// lockstep.
///
/// - A ray starts a little ahead of its surface, in proportion to the coordinates, so as not to hit it again. Closer
///   surfaces (the tip of a wedge) are missed.
/// - A path tracks at most eight solids around it.
/// Throws Error for settings, a camera or a buffer out of range. `threads` 0: all cores.
void trace_float(const Geometry& geometry, const Camera& camera, const ExactSettings& settings, std::uint32_t threads,
                 std::span<glm::vec3> directions);

}  // namespace pellucid::reference
