#include "reference/surface_frame.h"

#include <algorithm>
#include <cmath>

namespace pellucid::reference {
namespace {

constexpr double kFlat = 1e-4;         // less is the rounding of a flat texture
constexpr double kLeastCosine = 0.01;  // to the triangle's normal

/// -1..1. Of 8 bits 128 stands for 0, so that a flat texture is flat.
double signed_channel(float stored) { return std::clamp((255.0 * double(stored) - 128.0) / 127.0, -1.0, 1.0); }

/// The mesh's own tangents. A zero vector at a corner leaves it to the triangle.
std::optional<glm::dvec4> vertex_tangent(const Geometry& geometry, const Hit& hit) {
    const auto [object, triangle, sense, shell] = hit.crossing;
    const Mesh& mesh = geometry.mesh(object);
    if (mesh.tangents.empty() || geometry.has_moved(object)) return std::nullopt;
    const glm::uvec3 t = mesh.triangles[triangle];
    const glm::dvec4 a(mesh.tangents[t.x]), b(mesh.tangents[t.y]), c(mesh.tangents[t.z]);
    if (a.w * b.w <= 0.0 || a.w * c.w <= 0.0) return std::nullopt;
    const glm::dvec3 along = (1.0 - hit.u - hit.v) * glm::dvec3(a) + hit.u * glm::dvec3(b) + hit.v * glm::dvec3(c);
    // A mirror turns the frame around.
    return glm::dvec4(geometry.to_world(object) * along, geometry.mirrored(object) ? -a.w : a.w);
}

std::optional<glm::dvec4> triangle_tangent(const Geometry& geometry, const Hit& hit, const glm::dvec3& normal,
                                           int set) {
    const auto [object, triangle, sense, shell] = hit.crossing;
    const Mesh& mesh = geometry.mesh(object);
    if (mesh.texcoords[set].empty()) return std::nullopt;
    const glm::uvec3 t = mesh.triangles[triangle];
    const glm::dvec2 a(mesh.texcoords[set][t.x]);
    const glm::dvec2 b = glm::dvec2(mesh.texcoords[set][t.y]) - a, c = glm::dvec2(mesh.texcoords[set][t.z]) - a;
    const double area = b.x * c.y - b.y * c.x;
    if (area == 0.0) return std::nullopt;
    const auto [p, q, r] = geometry.corner_positions(object, triangle);
    const glm::dvec3 edge_b = glm::dvec3(q) - glm::dvec3(p), edge_c = glm::dvec3(r) - glm::dvec3(p);
    const glm::dvec3 along = (edge_b * c.y - edge_c * b.y) / area, up = (edge_b * c.x - edge_c * b.x) / area;
    return glm::dvec4(along, glm::dot(glm::cross(normal, along), up) < 0.0 ? -1.0 : 1.0);
}

}  // namespace

std::optional<glm::dmat3> tangent_frame(const Geometry& geometry, const Hit& hit, const glm::dvec3& normal, int set) {
    std::optional<glm::dvec4> tangent = vertex_tangent(geometry, hit);
    if (!tangent) tangent = triangle_tangent(geometry, hit, normal, set);
    if (!tangent) return std::nullopt;
    glm::dvec3 along(*tangent);
    along -= normal * glm::dot(normal, along);
    const double length = glm::length(along);
    if (!(length > 0.0) || !std::isfinite(length)) return std::nullopt;
    along /= length;
    return glm::dmat3(along, tangent->w * glm::cross(normal, along), normal);
}

glm::dvec3 tilted_normal(const Scene& scene, const Geometry& geometry, const Hit& hit, const glm::dvec3& normal,
                         const Texture& texture, double scale, const SurfaceAttributes& attributes) {
    if (texture.image < 0) return normal;
    const glm::vec4 stored = sample_texture(scene, texture, Encoding::kLinear, attributes);
    const double x = scale * signed_channel(stored.r), y = scale * signed_channel(stored.g);
    if (std::max(std::abs(x), std::abs(y)) < kFlat) return normal;
    const std::optional<glm::dmat3> frame = tangent_frame(geometry, hit, normal, texture.texcoord_set);
    if (!frame) return normal;
    const double z = std::max(signed_channel(stored.b), kLeastCosine);
    return glm::normalize(*frame * glm::dvec3(x, y, z));
}

glm::dvec3 mirroring_above(const glm::dvec3& normal, const glm::dvec3& flat, const glm::dvec3& to_viewer) {
    const glm::dvec3 mirrored = 2.0 * glm::dot(normal, to_viewer) * normal - to_viewer;
    const double height = glm::dot(mirrored, flat);
    if (height >= kLeastCosine) return normal;
    return glm::normalize(to_viewer + glm::normalize(mirrored + (kLeastCosine - height) * flat));
}

}  // namespace pellucid::reference
