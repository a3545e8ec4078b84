#pragma once

#include "core/math.h"

#include <vector>

namespace pellucid {

/// The outline of the shape `goblet` in the half plane of distance from the axis and height: `rings` stretches from the
/// axis to the axis.
std::vector<glm::dvec2> goblet_outline(double wall, int rings);

}  // namespace pellucid
