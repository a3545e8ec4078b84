#pragma once

#include "scene/shells.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace pellucid {

/// Range of winding numbers next to a closed shell's own triangles. A simple outward shell has 0 and 1, an inward
/// shell -1 and 0. A shell that crosses itself has more.
struct WindingRange {
    int least = 0;  ///< <= 0
    int most = 1;   ///< >= 0
    bool crosses_itself() const { return most - least > 1; }
    bool operator==(const WindingRange&) const = default;
};

/// Winding ranges of all shells; open shells count as simple. Each triangle gets one sample, and more in proportion to
/// its area. Smaller features may be missed.
std::vector<WindingRange> winding_ranges(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                                         const Shells& shells);

}  // namespace pellucid
