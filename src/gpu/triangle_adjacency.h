#pragma once

#include <pellucid/scene.h>

#include <cstdint>
#include <vector>

namespace pellucid {

/// A triangle's neighbours across its edges; edge k runs from corner k to the next.
struct Neighbor {
    static constexpr std::uint32_t kNone = 0xffffffffu;
    std::uint32_t triangle = kNone;         ///< of the same mesh; none: a rim, or more than two triangles meet here
    std::uint32_t opposite_vertex = kNone;  ///< of the mesh: the corner of that triangle that is not on the edge
};

/// Three per triangle. Vertices at the same position count as one.
std::vector<Neighbor> triangle_neighbors(const Mesh& mesh);

/// True if every edge has exactly two triangles, which run along it in opposite directions: the surface bounds a solid.
bool is_closed(const std::vector<Neighbor>& neighbors);

}  // namespace pellucid
