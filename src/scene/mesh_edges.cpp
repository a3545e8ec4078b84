#include "scene/mesh_edges.h"

#include <algorithm>
#include <numeric>

namespace pellucid {

std::vector<HalfEdge> sorted_half_edges(std::span<const glm::uvec3> triangles, std::span<const std::uint32_t> weld) {
    std::vector<HalfEdge> edges;
    edges.reserve(3 * triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const glm::uvec3 w(weld[triangles[t].x], weld[triangles[t].y], weld[triangles[t].z]);
        if (w.x == w.y || w.y == w.z || w.z == w.x) continue;
        for (int k = 0; k < 3; ++k) {
            const std::uint64_t a = w[k], b = w[(k + 1) % 3];
            edges.push_back({a < b ? a << 32 | b : b << 32 | a, t, a < b});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) { return a.ends < b.ends; });
    return edges;
}

DisjointSets::DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }

std::uint32_t DisjointSets::root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
}

}  // namespace pellucid
