#include "bake/inward_distances.h"

#include "bake/mesh_rays.h"
#include "bake/parallel_items.h"

namespace pellucid::bake {

std::vector<float> inward_distances(const Mesh& mesh, std::uint32_t threads, const Progress& progress) {
    const MeshRays rays(mesh, threads);
    std::vector<float> distances(mesh.positions.size());
    for_each_item(distances.size(), threads, progress, [&](std::size_t vertex) {
        const auto hit = rays.leave_from_vertex(std::uint32_t(vertex), -mesh.normals[vertex]);
        distances[vertex] = hit ? hit->distance : 0.0f;
    });
    return distances;
}

}  // namespace pellucid::bake
