#include "scene/mesh_tangents.h"

#include <fmt/format.h>

#include <cmath>

namespace pellucid {
namespace {

/// Angle of a triangle at corner `a`, radians.
double angle_at(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 u = b - a, v = c - a;
    return std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
}

int tangent_set(const Material& material) {
    if (material.normal_texture.image >= 0) return material.normal_texture.texcoord_set;
    const Finish& finish = material.finish;
    if (finish.clearcoat_normal_texture.image >= 0) return finish.clearcoat_normal_texture.texcoord_set;
    return finish.anisotropy_texture.image >= 0 ? finish.anisotropy_texture.texcoord_set : 0;
}

}  // namespace

std::vector<glm::vec4> make_tangents(const Mesh& mesh, int texcoord_set) {
    const std::vector<glm::vec2>& uv = mesh.texcoords[texcoord_set];
    if (uv.empty()) return {};
    const std::size_t count = mesh.positions.size();
    std::vector<glm::dvec3> sums(count, glm::dvec3(0.0));
    std::vector<int> left(count, 0), right(count, 0);
    for (const glm::uvec3 t : mesh.triangles) {
        const glm::dvec3 p[3] = {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
        const glm::dvec2 b = glm::dvec2(uv[t.y]) - glm::dvec2(uv[t.x]), c = glm::dvec2(uv[t.z]) - glm::dvec2(uv[t.x]);
        const double area = b.x * c.y - b.y * c.x;
        if (area == 0.0) continue;
        const glm::dvec3 along = ((p[1] - p[0]) * c.y - (p[2] - p[0]) * b.y) * (area < 0.0 ? -1.0 : 1.0);
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t v = t[k];
            const glm::dvec3 n(mesh.normals[v]), flat = along - n * glm::dot(n, along);
            const double length = glm::length(flat);
            if (!(length > 0.0)) continue;
            sums[v] += flat / length * angle_at(p[k], p[(k + 1) % 3], p[(k + 2) % 3]);
            // With v running downwards, texture coordinates that run as the corners do are mirrored.
            ++(area < 0.0 ? right : left)[v];
        }
    }
    std::vector<glm::vec4> tangents(count, glm::vec4(0.0f));
    for (std::size_t v = 0; v < count; ++v) {
        const double length = glm::length(sums[v]);
        if (!(length > 1e-6) || (left[v] > 0 && right[v] > 0)) continue;
        tangents[v] = glm::vec4(glm::vec3(sums[v] / length), right[v] > 0 ? 1.0f : -1.0f);
    }
    return tangents;
}

void add_tangents(Scene& scene, const std::vector<char>& deforming, Warnings& warnings) {
    std::vector<char> needed(scene.meshes.size(), 0);
    for (const Object& object : scene.objects) {
        const auto m = std::size_t(object.mesh);
        const Material& material = scene.materials[std::size_t(object.material)];
        if (!material.uses_tangents()) continue;
        if (scene.meshes[m].texcoords[tangent_set(material)].empty())
            warnings.add(
                fmt::format("{}: without texture coordinates its normal texture and anisotropy have no direction",
                            scene.meshes[m].name));
        if (m < deforming.size() && deforming[m] != 0) continue;
        needed[m] = 1;
        Mesh& mesh = scene.meshes[m];
        if (mesh.tangents.empty()) mesh.tangents = make_tangents(mesh, tangent_set(material));
    }
    for (std::size_t m = 0; m < scene.meshes.size(); ++m)
        if (needed[m] == 0) scene.meshes[m].tangents = {};
}

}  // namespace pellucid
