#include <pellucid/scene.h>

#include "core/math.h"

#include <algorithm>
#include <cmath>

namespace pellucid {

glm::vec3 Material::sigma_a() const {
    // Black would mean infinite absorption, and exp(-infinity * 0) is NaN. Use 1e-30 instead.
    const glm::vec3 left = glm::clamp(attenuation_color, glm::vec3(1e-30f), glm::vec3(1.0f));
    return glm::max(-glm::log(left), glm::vec3(0.0f)) / attenuation_distance;
}

std::uint64_t Scene::triangle_count() const {
    std::uint64_t count = 0;
    for (const Object& object : objects) count += meshes[std::size_t(object.mesh)].triangles.size();
    return count;
}

Bounds scene_bounds(const Scene& scene) {
    const auto for_each_vertex = [&](auto&& visit) {
        for (const Object& object : scene.objects) {
            const glm::dmat4 world_from_object(object.world_from_object);
            for (const glm::vec3 p : scene.meshes[std::size_t(object.mesh)].positions)
                visit(glm::dvec3(world_from_object * glm::dvec4(p, 1.0)));
        }
        for (const VolumeObject& object : scene.volume_objects) {
            const Volume& volume = *scene.volumes[std::size_t(object.volume)];
            for (int corner = 0; corner < 8; ++corner) {
                const glm::dvec3 at(corner & 1, corner >> 1 & 1, corner >> 2);
                const glm::dvec3 p = glm::mix(glm::dvec3(volume.low), glm::dvec3(volume.high()), at);
                visit(glm::dvec3(glm::dmat4(object.world_from_volume) * glm::dvec4(p, 1.0)));
            }
        }
    };
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for_each_vertex([&](const glm::dvec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    });
    if (!(low.x <= high.x)) return {};  // empty scene
    // Use the rounded centre for the radius, so that the sphere contains every vertex.
    const glm::vec3 center(0.5 * (low + high));
    double radius2 = 0.0;
    for_each_vertex([&](const glm::dvec3& p) {
        const glm::dvec3 d = p - glm::dvec3(center);
        radius2 = std::max(radius2, glm::dot(d, d));
    });
    return {center, static_cast<float>(std::sqrt(radius2)), glm::vec3(0.5 * (high - low))};
}

}  // namespace pellucid
