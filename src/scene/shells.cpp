#include "scene/shells.h"

#include "scene/mesh_edges.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace pellucid {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// Directions around an edge that differ by less than this, in radians, count as equal.
constexpr double kSameAngle = 1e-5;

/// A triangle at an edge, seen along the edge from its first end to its second.
struct Leaf {
    double angle;  ///< radians, counter-clockwise
    bool ends;     ///< true if material lies before the triangle in counter-clockwise order, false if behind
    std::uint32_t triangle;
};

std::vector<Leaf> leaves_at(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                            std::span<const HalfEdge> edge, std::span<const std::uint32_t> weld) {
    const auto first = std::uint32_t(edge[0].ends >> 32), second = std::uint32_t(edge[0].ends);
    const glm::dvec3 a = positions[first], axis = glm::normalize(glm::dvec3(positions[second]) - a);
    const glm::dvec3 beside = std::abs(axis.x) < 0.6 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
    const glm::dvec3 x = glm::normalize(glm::cross(axis, beside)), y = glm::cross(axis, x);
    std::vector<Leaf> leaves;
    for (const HalfEdge& side : edge) {
        glm::dvec3 way(0.0);
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t corner = triangles[side.triangle][k];
            if (weld[corner] != first && weld[corner] != second) way = glm::dvec3(positions[corner]) - a;
        }
        leaves.push_back({std::atan2(glm::dot(way, y), glm::dot(way, x)), side.forward, side.triangle});
    }
    std::sort(leaves.begin(), leaves.end(), [](const Leaf& l, const Leaf& m) { return l.angle < m.angle; });
    // Start counting at the widest gap: rounding may give directions near half a turn either sign.
    std::size_t first_leaf = 0;
    double widest = leaves.front().angle + 2.0 * std::numbers::pi - leaves.back().angle;
    for (std::size_t i = 1; i < leaves.size(); ++i) {
        if (leaves[i].angle - leaves[i - 1].angle <= widest) continue;
        widest = leaves[i].angle - leaves[i - 1].angle;
        first_leaf = i;
    }
    for (std::size_t i = 0; i < first_leaf; ++i) leaves[i].angle += 2.0 * std::numbers::pi;
    std::rotate(leaves.begin(), leaves.begin() + std::ptrdiff_t(first_leaf), leaves.end());
    // Among equal directions, order triangles that end material first: touching surfaces are not joined.
    for (std::size_t begin = 0, end; begin < leaves.size(); begin = end) {
        for (end = begin + 1; end < leaves.size() && leaves[end].angle - leaves[end - 1].angle < kSameAngle;) ++end;
        std::stable_sort(leaves.begin() + std::ptrdiff_t(begin), leaves.begin() + std::ptrdiff_t(end),
                         [](const Leaf& l, const Leaf& m) { return l.ends && !m.ends; });
        for (std::size_t i = begin; i < end; ++i) leaves[i].angle = leaves[begin].angle;
    }
    return leaves;
}

/// Joins the triangles at an edge that have material between them, all around the edge.
void join_leaves(std::vector<Leaf> leaves, DisjointSets& sets) {
    std::vector<Leaf> begun;
    for (int round = 0; round < 2; ++round) {
        std::vector<Leaf> left;
        for (std::size_t i = 0; i < leaves.size(); ++i) {
            if (!leaves[i].ends) {
                if (round == 0) begun.push_back(leaves[i]);
                continue;
            }
            if (begun.empty()) {
                left.push_back(leaves[i]);
                continue;
            }
            // Among ends in equal directions, choose the triangle nearest in the file, because a file stores shells
            // contiguously.
            const std::uint32_t start = begun.back().triangle;
            const auto apart = [&](const Leaf& leaf) {
                return std::max(leaf.triangle, start) - std::min(leaf.triangle, start);
            };
            std::size_t nearest = i;
            for (std::size_t k = i + 1; k < leaves.size() && leaves[k].ends && leaves[k].angle == leaves[i].angle; ++k)
                if (apart(leaves[k]) < apart(leaves[nearest])) nearest = k;
            std::swap(leaves[i], leaves[nearest]);
            sets.join(leaves[i].triangle, start);
            begun.pop_back();
        }
        leaves = std::move(left);
    }
}

}  // namespace

bool Shells::all_closed() const {
    return std::all_of(closed.begin(), closed.end(), [](char shell) { return shell != 0; });
}

Shells find_shells(std::span<const glm::vec3> positions, std::span<const glm::uvec3> triangles,
                   std::span<const std::uint32_t> weld) {
    const std::vector<HalfEdge> sides = sorted_half_edges(triangles, weld);
    DisjointSets sets(triangles.size());
    std::vector<std::uint32_t> open;
    for_each_edge(sides, [&](std::span<const HalfEdge> edge) {
        const auto forward = std::count_if(edge.begin(), edge.end(), [](const HalfEdge& side) { return side.forward; });
        if (2 * std::size_t(forward) == edge.size() && edge.size() > 2) {
            join_leaves(leaves_at(positions, triangles, edge, weld), sets);
            return;
        }
        for (const HalfEdge& side : edge) sets.join(side.triangle, edge[0].triangle);
        if (2 * std::size_t(forward) != edge.size()) open.push_back(edge[0].triangle);
    });

    // Degenerate triangles belong to a surface that they touch.
    std::vector<std::uint32_t> at_vertex(weld.size(), kNone);
    for (const HalfEdge& side : sides)
        for (int k = 0; k < 3; ++k) at_vertex[weld[triangles[side.triangle][k]]] = side.triangle;
    for (std::uint32_t t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k)
            if (const std::uint32_t v = weld[triangles[t][k]];
                v == weld[triangles[t][(k + 1) % 3]] && at_vertex[v] != kNone)
                sets.join(t, at_vertex[v]);

    Shells shells;
    shells.of_triangle.resize(triangles.size());
    std::vector<std::uint32_t> number(triangles.size(), kNone);
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        std::uint32_t& shell = number[sets.root(t)];
        if (shell == kNone) {
            shell = shells.count();
            shells.closed.push_back(1);
        }
        shells.of_triangle[t] = shell;
    }
    for (const std::uint32_t triangle : open) shells.closed[shells.of_triangle[triangle]] = 0;
    return shells;
}

}  // namespace pellucid
