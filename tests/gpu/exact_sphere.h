#pragma once

// The exact path through a sphere of glass.
#include "optics/interface.h"

#include "gpu/gpu_test.h"

#include <optional>

namespace pellucid::test {

/// Exit of a ray from a unit sphere around the origin after entry and exit, in double precision.
/// By symmetry the exit angle equals the entry angle: there is no total internal reflection.
struct SphereExit {
    glm::dvec3 position, direction;
    double length;  ///< m, inside
};
inline std::optional<SphereExit> through_unit_sphere(WorldRay ray, double ior) {
    const double b = glm::dot(ray.origin, ray.direction);
    const double discriminant = b * b - glm::dot(ray.origin, ray.origin) + 1.0;
    if (discriminant < 0.0) return std::nullopt;
    const glm::dvec3 entry = ray.origin + (-b - std::sqrt(discriminant)) * ray.direction;
    glm::dvec3 inside{}, exit_direction{};
    refract_direction(ray.direction, entry, 1.0 / ior, inside);
    const double length = -2.0 * glm::dot(entry, inside);
    const glm::dvec3 exit = entry + length * inside;
    if (!refract_direction(inside, -exit, ior, exit_direction)) return std::nullopt;
    return SphereExit{exit, exit_direction, length};
}

}  // namespace pellucid::test
