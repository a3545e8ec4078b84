#pragma once

#include "scene/shells.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace pellucid {

/// Winding numbers that a closed shell has next to its own triangles: 0 and 1 where it is simple and wound outward, -1 and
/// 0 where it is wound inward, more where it crosses itself.
struct WindingRange {
    int least = 0;  ///< <= 0
    int most = 1;   ///< >= 0
    bool crosses_itself() const { return most - least > 1; }
    bool operator==(const WindingRange&) const = default;
};

/// Of each shell; those that are open count as simple. Each triangle is sampled at one point, and at more by its share of
/// the area: what only smaller parts of the surface reach is not seen.
std::vector<WindingRange> winding_ranges(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                                         const Shells& shells);

}  // namespace pellucid
