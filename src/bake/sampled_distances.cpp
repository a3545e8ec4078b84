#include "bake/sampled_distances.h"

#include "bake/mesh_rays.h"
#include "bake/parallel_items.h"

#include <algorithm>
#include <cmath>

namespace pellucid::bake {
namespace {

/// Unit vector at the centre of texel `texel` of an octahedral map; see octahedral.glsl.
glm::vec3 octahedral_direction(std::size_t texel, std::uint32_t side) {
    const glm::vec2 at(float(texel % side), float(texel / side));
    const glm::vec2 p = (at + 0.5f) * (2.0f / float(side)) - 1.0f;
    glm::vec3 n(p, 1.0f - std::abs(p.x) - std::abs(p.y));
    if (n.z < 0.0f) {
        n.x = (1.0f - std::abs(p.y)) * (p.x >= 0.0f ? 1.0f : -1.0f);
        n.y = (1.0f - std::abs(p.x)) * (p.y >= 0.0f ? 1.0f : -1.0f);
    }
    return glm::normalize(n);
}

}  // namespace

MeshSphere mesh_sphere(const Mesh& mesh) {
    if (mesh.positions.empty()) return {glm::vec3(0.0f), 0.0f};
    glm::vec3 low = mesh.positions.front(), high = low;
    for (const glm::vec3& p : mesh.positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::vec3 center = low + 0.5f * (high - low);
    float radius = 0.0f;
    for (const glm::vec3& p : mesh.positions) radius = std::max(radius, glm::distance(p, center));
    return {center, radius};
}

std::vector<float> sampled_distances(const Mesh& mesh, std::uint32_t side, std::uint32_t threads,
                                     const Progress& progress) {
    const MeshRays rays(mesh, threads);
    const MeshSphere sphere = mesh_sphere(mesh);
    const std::size_t directions = std::size_t(side) * side;
    std::vector<float> distances(sampled_distance_count(side), kNoDistance);
    for_each_item(directions, threads, progress, [&](std::size_t point) {
        const glm::vec3 outwards = octahedral_direction(point, side);
        const auto start = rays.enter(sphere.center + 2.0f * sphere.radius * outwards, -outwards);
        if (!start) return;
        for (std::size_t d = 0; d < directions; ++d) {
            const glm::vec3 direction = octahedral_direction(d, side);
            if (!rays.enters(start->triangle, direction)) continue;
            const auto end = rays.leave_from_triangle(start->position, start->triangle, direction);
            if (end) distances[point * directions + d] = end->distance;
        }
    });
    return distances;
}

}  // namespace pellucid::bake
