#pragma once

#include <glm/glm.hpp>

#include <cmath>

namespace pellucid::reference {

/// Rotation that takes the z axis to the unit vector n: Duff et al., "Building an orthonormal basis,
/// revisited", 2017, listing 3.
inline glm::dmat3 world_from_local(const glm::dvec3& n) {
    const double sign = std::copysign(1.0, n.z);
    const double a = -1.0 / (sign + n.z);
    const double b = n.x * n.y * a;
    return {glm::dvec3(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), glm::dvec3(b, sign + n.y * n.y * a, -n.y),
            n};
}

}  // namespace pellucid::reference
