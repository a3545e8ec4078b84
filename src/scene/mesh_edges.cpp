#include "scene/mesh_edges.h"

#include <algorithm>
#include <numeric>
#include <utility>

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

DisjointSets near_vertices(std::span<const glm::vec3> positions, std::span<const std::uint32_t> vertices,
                           float tolerance) {
    // Sort along a line that is aligned with no file's grid: nearby positions are then nearby in the list.
    std::vector<std::pair<float, std::uint32_t>> order;
    for (const std::uint32_t v : vertices)
        order.emplace_back(glm::dot(positions[v] - positions[vertices[0]], glm::vec3(0.48f, 0.6f, 0.64f)), v);
    std::sort(order.begin(), order.end());
    DisjointSets sets(positions.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        for (std::size_t k = i + 1; k < order.size() && order[k].first - order[i].first <= 2.0f * tolerance; ++k)
            if (glm::distance(positions[order[i].second], positions[order[k].second]) <= tolerance)
                sets.join(order[k].second, order[i].second);
    return sets;
}

float weld_tolerance(std::span<const glm::vec3> positions) {
    if (positions.empty()) return 0.0f;
    glm::vec3 low(positions[0]), high(low);
    for (const glm::vec3& p : positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::vec3 size = high - low;
    return 1e-6f * std::max({size.x, size.y, size.z});
}

}  // namespace pellucid
