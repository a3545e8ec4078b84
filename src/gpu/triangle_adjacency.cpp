#include "gpu/triangle_adjacency.h"

#include "scene/mesh_repair.h"

#include <algorithm>

namespace pellucid {
namespace {

/// An edge as one of its triangles runs along it.
struct Edge {
    std::uint32_t low, high;  ///< welded vertices
    std::uint32_t corner;     ///< 3 * triangle + where it starts
    bool rising;              ///< from `low` to `high`
};

}  // namespace

std::vector<Neighbor> triangle_neighbors(const Mesh& mesh) {
    const std::vector<std::uint32_t> weld = weld_positions(mesh.positions);
    std::vector<Edge> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t from = weld[mesh.triangles[t][k]], to = weld[mesh.triangles[t][(k + 1) % 3]];
            edges.push_back({std::min(from, to), std::max(from, to), std::uint32_t(3 * t + std::size_t(k)), from < to});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
        return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.corner < b.corner;
    });
    std::vector<Neighbor> neighbors(edges.size());
    const auto join = [&](const Edge& here, const Edge& there) {
        const std::uint32_t triangle = there.corner / 3;
        neighbors[here.corner] = {triangle, mesh.triangles[triangle][int(there.corner % 3 + 2) % 3]};
    };
    for (std::size_t first = 0, end = 0; first < edges.size(); first = end) {
        while (end < edges.size() && edges[end].low == edges[first].low && edges[end].high == edges[first].high) ++end;
        if (end - first != 2 || edges[first].rising == edges[first + 1].rising) continue;
        join(edges[first], edges[first + 1]);
        join(edges[first + 1], edges[first]);
    }
    return neighbors;
}

bool is_closed(const std::vector<Neighbor>& neighbors) {
    return std::none_of(neighbors.begin(), neighbors.end(),
                        [](const Neighbor& n) { return n.triangle == Neighbor::kNone; });
}

}  // namespace pellucid
