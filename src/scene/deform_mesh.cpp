// Morph targets and skins (Khronos Group, glTF 2.0 Specification, 2021, sections 3.7.2.2 and 3.7.3).
#include "scene/deform_mesh.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace pellucid {
namespace {

bool usable(float length) { return length > 0.0f && std::isfinite(length); }

std::span<const float> weights_of(const DeformedMesh& mesh, const NodePose& pose) {
    const auto animated = pose.weights.find(mesh.weights_node);
    return animated != pose.weights.end() ? animated->second : mesh.weights;
}

/// Adds the weighted displacements of `list`, either positions or normals.
void morph(const std::vector<MorphTarget>& targets, std::span<const float> weights,
           std::vector<glm::vec3> MorphTarget::*list, std::vector<glm::vec3>& vectors) {
    for (std::size_t t = 0; t < targets.size() && t < weights.size(); ++t) {
        const std::vector<glm::vec3>& displacements = targets[t].*list;
        if (weights[t] == 0.0f) continue;
        for (std::size_t v = 0; v < displacements.size(); ++v) vectors[v] += weights[t] * displacements[v];
    }
}

std::vector<glm::mat4x3> world_from_bind(const Skin& skin, const NodePose& pose) {
    std::vector<glm::mat4x3> matrices;
    matrices.reserve(skin.joints.size());
    for (std::size_t j = 0; j < skin.joints.size(); ++j)
        matrices.emplace_back(pose.world_from_node[std::size_t(skin.joints[j])] * skin.joint_from_bind[j]);
    return matrices;
}

glm::mat4x3 blended(const Influences& influences, const std::vector<glm::mat4x3>& matrices, std::size_t vertex) {
    glm::mat4x3 sum(0.0f);
    for (std::uint32_t i = influences.first[vertex]; i < influences.first[vertex + 1]; ++i)
        sum += influences.weight[i] * matrices[influences.joint[i]];
    return sum;
}

double determinant(const glm::mat4x3& m) { return glm::determinant(glm::dmat3(m[0], m[1], m[2])); }

/// Transforms a normal by the inverse transpose: up to length the cofactor matrix, with its sign reversed if `m`
/// mirrors.
glm::vec3 transformed_normal(const glm::mat4x3& m, const glm::vec3& normal) {
    const glm::dvec3 x(m[0]), y(m[1]), z(m[2]);
    const glm::dvec3 yz = glm::cross(y, z);
    const glm::dvec3 n =
        double(normal.x) * yz + double(normal.y) * glm::cross(z, x) + double(normal.z) * glm::cross(x, y);
    const double length = glm::length(n);
    if (!(length > 0.0) || !std::isfinite(length)) return glm::vec3(0.0f);
    return glm::vec3(n / (glm::dot(x, yz) < 0.0 ? -length : length));
}

/// Normals per group of vertices: mean of the surrounding triangles' normals, weighted by area.
void make_group_normals(const Shape& shape, bool mirrored, DeformedVertices& vertices) {
    std::vector<glm::dvec3> sums(vertices.positions.size(), glm::dvec3(0.0));
    for (const glm::uvec3 t : shape.base.triangles) {
        const glm::dvec3 a = vertices.positions[t.x];
        const glm::dvec3 area =
            glm::cross(glm::dvec3(vertices.positions[t.y]) - a, glm::dvec3(vertices.positions[t.z]) - a);
        for (int k = 0; k < 3; ++k) sums[shape.normal_group[t[k]]] += mirrored ? -area : area;
    }
    for (std::size_t v = 0; v < vertices.normals.size(); ++v) {
        const glm::dvec3 sum = sums[shape.normal_group[v]];
        const double length = glm::length(sum);
        vertices.normals[v] = length > 0.0 && std::isfinite(length) ? glm::vec3(sum / length) : glm::vec3(0.0f);
    }
}

}  // namespace

bool DeformedVertices::finite() const {
    return std::all_of(positions.begin(), positions.end(), [](const glm::vec3& p) {
        return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    });
}

DeformedVertices deform(const Rig& rig, const DeformedMesh& mesh, const NodePose& pose) {
    const Shape& shape = rig.shapes[mesh.shape];
    const std::span<const float> weights = weights_of(mesh, pose);
    DeformedVertices result{.positions = shape.base.positions, .normals = shape.base.normals};
    morph(shape.targets, weights, &MorphTarget::positions, result.positions);
    morph(shape.targets, weights, &MorphTarget::normals, result.normals);
    if (mesh.skin >= 0) {
        const std::vector<glm::mat4x3> matrices = world_from_bind(rig.skins[std::size_t(mesh.skin)], pose);
        for (std::size_t v = 0; v < result.positions.size(); ++v) {
            const glm::mat4x3 m = blended(shape.influences, matrices, v);
            result.positions[v] = m * glm::vec4(result.positions[v], 1.0f);
            result.normals[v] = transformed_normal(m, result.normals[v]);
        }
    }
    if (!shape.normal_group.empty()) make_group_normals(shape, mesh.mirrored, result);
    for (std::size_t v = 0; v < result.normals.size(); ++v) {
        // If the surface has shrunk to zero area, keep the direction at rest.
        const float length = glm::length(result.normals[v]);
        result.normals[v] = usable(length) ? result.normals[v] / length : shape.base.normals[v];
    }
    return result;
}

bool skin_mirrors(const Rig& rig, const DeformedMesh& mesh, const NodePose& pose) {
    if (mesh.skin < 0) return false;
    const Shape& shape = rig.shapes[mesh.shape];
    const std::vector<glm::mat4x3> matrices = world_from_bind(rig.skins[std::size_t(mesh.skin)], pose);
    std::size_t mirrored = 0;
    for (std::size_t v = 0; v < shape.base.positions.size(); ++v)
        mirrored += determinant(blended(shape.influences, matrices, v)) < 0.0;
    return 2 * mirrored > shape.base.positions.size();
}

}  // namespace pellucid
