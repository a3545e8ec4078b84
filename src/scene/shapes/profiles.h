#pragma once

#include "core/math.h"

#include <vector>

namespace pellucid {

/// Outline of the shape `goblet` in the half plane (distance from the axis, height), from axis to axis in `rings`
/// segments.
std::vector<glm::dvec2> goblet_outline(double wall, int rings);

}  // namespace pellucid
