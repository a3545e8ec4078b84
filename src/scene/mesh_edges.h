#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace pellucid {

/// A side of a triangle, between welded vertices.
struct HalfEdge {
    std::uint64_t ends;  ///< smaller vertex << 32 | larger vertex: equal for all triangles at one edge
    std::uint32_t triangle;
    bool forward;  ///< runs from the smaller to the larger vertex
};
/// The sides of all triangles, ordered by `ends`. Triangles with two corners welded together are degenerate and
/// skipped.
std::vector<HalfEdge> sorted_half_edges(std::span<const glm::uvec3> triangles, std::span<const std::uint32_t> weld);

/// Calls `function` with the sides at each edge.
template <class Function>
void for_each_edge(const std::vector<HalfEdge>& sides, Function function) {
    for (std::size_t begin = 0, end; begin < sides.size(); begin = end) {
        for (end = begin; end < sides.size() && sides[end].ends == sides[begin].ends;) ++end;
        function(std::span(sides).subspan(begin, end - begin));
    }
}

/// Disjoint sets of the numbers 0 .. count - 1, with path halving (Tarjan 1975).
class DisjointSets {
public:
    explicit DisjointSets(std::size_t count);
    /// The representative of the set of `i`.
    std::uint32_t root(std::uint32_t i);
    void join(std::uint32_t a, std::uint32_t b) { parent_[root(a)] = root(b); }

private:
    std::vector<std::uint32_t> parent_;
};

/// Groups `vertices` that are connected by distances within `tolerance`; every other vertex is a set of its own.
DisjointSets near_vertices(std::span<const glm::vec3> positions, std::span<const std::uint32_t> vertices,
                           float tolerance);

/// 1e-6 of the longest side of the positions' box: closer positions count as equal.
float weld_tolerance(std::span<const glm::vec3> positions);

}  // namespace pellucid
