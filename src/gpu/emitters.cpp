#include "gpu/emitters.h"

#include <glm/glm.hpp>

namespace pellucid {
namespace {

double area_of(const Mesh& mesh, const glm::mat4& world_from_object, const glm::uvec3& corners) {
    const auto at = [&](std::uint32_t vertex) {
        return glm::dvec3(world_from_object * glm::vec4(mesh.positions[vertex], 1.0f));
    };
    const glm::dvec3 a = at(corners.x);
    return 0.5 * glm::length(glm::cross(at(corners.y) - a, at(corners.z) - a));
}

}  // namespace

bool emits_light(const Material& material) {
    return !material.transmissive() && !material.unlit && material.emission != glm::vec3(0.0f);
}

std::vector<EmitterRecord> emitters_of(const Scene& scene, std::span<const std::uint32_t> first_triangles) {
    std::vector<EmitterRecord> emitters;
    std::vector<double> emissions, powers;  // per triangle; powers omit common factors
    double total = 0.0;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        const Material& material = scene.materials[std::size_t(object.material)];
        if (!emits_light(material)) continue;
        const Mesh& mesh = scene.meshes[std::size_t(object.mesh)];
        const double emission = double(material.emission.r) + double(material.emission.g) + double(material.emission.b);
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const double power = emission * area_of(mesh, object.world_from_object, mesh.triangles[t]);
            if (!(power > 0.0)) continue;
            emitters.push_back({std::uint32_t(i), first_triangles[i] + std::uint32_t(t), 0.0f, 0.0f});
            emissions.push_back(emission);
            powers.push_back(power);
            total += power;
        }
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < emitters.size(); ++i) {
        sum += powers[i];
        emitters[i].cumulative = i + 1 == emitters.size() ? 1.0f : float(sum / total);
        emitters[i].density = float(emissions[i] / total);  // power / total / area
    }
    return emitters;
}

}  // namespace pellucid
