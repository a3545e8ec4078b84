// A hierarchy of boxes, split at the median along the longest side. The order of nodes allows a walk without a stack
// (Smits, "Efficiency issues for ray tracing", Journal of Graphics Tools 3(2), 1998).
#include "volume/opaque_tree.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <span>

namespace pellucid {
namespace {

constexpr std::size_t kMostInLeaf = 4;
constexpr float kMargin = 1e-6f;  // of boxes, relative to their coordinates; covers rounding

struct Box {
    glm::vec3 low{std::numeric_limits<float>::max()}, high{-std::numeric_limits<float>::max()};
    void add(glm::vec3 point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
};

glm::vec3 center_of(const gpu::OpaqueTriangle& triangle) {
    return glm::vec3(triangle.corner) + (glm::vec3(triangle.edge_b) + glm::vec3(triangle.edge_c)) / 3.0f;
}

Box box_around(std::span<const gpu::OpaqueTriangle> triangles) {
    Box box;
    for (const gpu::OpaqueTriangle& triangle : triangles) {
        const glm::vec3 corner(triangle.corner);
        box.add(corner);
        box.add(corner + glm::vec3(triangle.edge_b));
        box.add(corner + glm::vec3(triangle.edge_c));
    }
    const glm::vec3 margin = kMargin * glm::max(glm::abs(box.low), glm::abs(box.high));
    return {box.low - margin, box.high + margin};
}

/// Orders the triangles so that the first half lies below the second, along the axis of the largest extent of centres.
void halve(std::span<gpu::OpaqueTriangle> triangles) {
    Box centers;
    for (const gpu::OpaqueTriangle& triangle : triangles) centers.add(center_of(triangle));
    const glm::vec3 extent = centers.high - centers.low;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    std::nth_element(triangles.begin(), triangles.begin() + std::ptrdiff_t(triangles.size() / 2), triangles.end(),
                     [axis](const auto& a, const auto& b) { return center_of(a)[axis] < center_of(b)[axis]; });
}

void add_nodes(OpaqueTree& tree, std::size_t first, std::size_t count) {
    const std::span own(tree.triangles.data() + first, count);
    const std::size_t node = tree.nodes.size();
    const Box box = box_around(own);
    const auto leaf = std::uint32_t(count <= kMostInLeaf ? 8 * first + count : 0);
    tree.nodes.push_back({glm::vec4(box.low, 0.0f), glm::vec4(box.high, std::bit_cast<float>(leaf))});
    if (leaf == 0) {
        halve(own);
        add_nodes(tree, first, count / 2);
        add_nodes(tree, first + count / 2, count - count / 2);
    }
    tree.nodes[node].low.w = std::bit_cast<float>(std::uint32_t(tree.nodes.size()));
}

}  // namespace

OpaqueTree build_opaque_tree(const Scene& scene) {
    OpaqueTree tree;
    for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        if (scene.materials[std::size_t(object.material)].transmissive()) continue;
        const Mesh& mesh = scene.meshes[std::size_t(object.mesh)];
        const auto world = [&](std::uint32_t vertex) {
            return glm::vec3(object.world_from_object * glm::vec4(mesh.positions[vertex], 1.0f));
        };
        for (const glm::uvec3 corners : mesh.triangles) {
            const glm::vec3 a = world(corners.x), b = world(corners.y) - a, c = world(corners.z) - a;
            if (glm::cross(b, c) == glm::vec3(0.0f)) continue;
            tree.triangles.push_back({glm::vec4(a, std::bit_cast<float>(i)), glm::vec4(b, 0.0f), glm::vec4(c, 0.0f)});
        }
    }
    if (!tree.triangles.empty()) add_nodes(tree, 0, tree.triangles.size());
    return tree;
}

}  // namespace pellucid
