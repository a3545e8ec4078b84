#include "bake/inverted_occlusion.h"

#include "bake/mesh_rays.h"
#include "bake/parallel_items.h"

#include "core/math.h"

#include <algorithm>
#include <cmath>

namespace pellucid::bake {
namespace {

/// Direction `index` of `count` about +Z, with a density proportional to the cosine. Points of a golden-angle spiral on
/// the disc are projected to the hemisphere (Malley's method).
glm::vec3 cosine_weighted(std::uint32_t index, std::uint32_t count) {
    const double r2 = (index + 0.5) / count, angle = 2.399963229728653 * index;
    const double r = std::sqrt(r2);
    return {float(r * std::cos(angle)), float(r * std::sin(angle)), float(std::sqrt(1.0 - r2))};
}

/// Rotates +Z to `n` (Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 2017).
glm::mat3 basis_of(const glm::vec3& n) {
    const float sign = std::copysign(1.0f, n.z), a = -1.0f / (sign + n.z), b = n.x * n.y * a;
    return {glm::vec3(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x), glm::vec3(b, sign + n.y * n.y * a, -n.y), n};
}

/// Per vertex, the mean of `value` of the distances that rays travel inside the solid.
template <class Value>
std::vector<float> mean_over_rays(const Mesh& mesh, std::uint32_t rays, std::uint32_t threads, const Progress& progress,
                                  Value value) {
    const MeshRays tracer(mesh, threads);
    std::vector<float> means(mesh.positions.size());
    for_each_item(means.size(), threads, progress, [&](std::size_t vertex) {
        const glm::mat3 into = basis_of(-mesh.normals[vertex]);
        double sum = 0.0;
        std::uint32_t found = 0;
        for (std::uint32_t ray = 0; ray < rays; ++ray) {
            const auto hit = tracer.leave_from_vertex(std::uint32_t(vertex), into * cosine_weighted(ray, rays));
            if (!hit) continue;
            sum += value(double(hit->distance));
            ++found;
        }
        means[vertex] = found > 0 ? float(sum / found) : 0.0f;
    });
    return means;
}

double half_diagonal(const Mesh& mesh) {
    if (mesh.positions.empty()) return 1.0;
    glm::vec3 low = mesh.positions.front(), high = low;
    for (const glm::vec3& position : mesh.positions) {
        low = glm::min(low, position);
        high = glm::max(high, position);
    }
    return std::max(0.5 * double(glm::distance(low, high)), 1e-30);
}

}  // namespace

std::vector<float> inverted_occlusion(const Mesh& mesh, std::uint32_t rays, std::uint32_t threads,
                                      const Progress& progress) {
    return mean_over_rays(mesh, rays, threads, progress, [](double distance) { return distance; });
}

std::vector<float> inside_share(const Mesh& mesh, std::uint32_t rays, std::uint32_t threads, const Progress& progress) {
    const double radius = half_diagonal(mesh);
    // Of a ball's samples along a ray, the cube of the distance counts those in front of the exit.
    return mean_over_rays(mesh, rays, threads, progress, [radius](double distance) {
        const double share = std::min(distance / radius, 1.0);
        return radius * share * share * share;
    });
}

}  // namespace pellucid::bake
