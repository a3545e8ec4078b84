#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace pellucid {

/// Triangles between the corners of a polygon, as their numbers and wound as the polygon is. A polygon need not be
/// convex nor quite flat; a bridge to a hole may run along an edge twice. Corners at the same position as the one before
/// are left out, and so triangles of 3 corners fewer. Ears are cut off (Meisters, "Polygons have ears", American
/// Mathematical Monthly 82, 1975). A polygon that crosses itself ends as a fan.
std::vector<std::array<std::uint32_t, 3>> triangulate_polygon(std::span<const glm::dvec3> corners);

}  // namespace pellucid
