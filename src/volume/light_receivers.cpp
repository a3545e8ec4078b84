#include "volume/light_receivers.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

namespace pellucid {
namespace {

constexpr double kFlat = 1e-4;  // how far vertices may lie off their plane, as a share of the object's extent

struct Rectangle {
    glm::dvec3 origin, side, up, normal;
    glm::dvec2 low, high;
    double area() const { return (high.x - low.x) * (high.y - low.y); }
};

Rectangle around(const std::vector<glm::dvec3>& points, glm::dvec3 origin, glm::dvec3 side, glm::dvec3 normal) {
    const double most = std::numeric_limits<double>::max();
    Rectangle result{origin, side, glm::cross(normal, side), normal, glm::dvec2(most), glm::dvec2(-most)};
    for (const glm::dvec3 point : points) {
        const glm::dvec2 at(glm::dot(point - origin, side), glm::dot(point - origin, result.up));
        result.low = glm::min(result.low, at);
        result.high = glm::max(result.high, at);
    }
    return result;
}

/// The smallest rectangle along an edge of the largest triangle; none if the points do not lie in a plane.
std::optional<Rectangle> rectangle_of(const Mesh& mesh, const glm::dmat4& world_from_object) {
    std::vector<glm::dvec3> points;
    for (const glm::vec3 position : mesh.positions)
        points.emplace_back(world_from_object * glm::dvec4(glm::dvec3(position), 1.0));
    glm::dvec3 normal(0.0);
    glm::uvec3 largest(0);
    for (const glm::uvec3 triangle : mesh.triangles) {
        const glm::dvec3 a = points[triangle.x];
        const glm::dvec3 square = glm::cross(points[triangle.y] - a, points[triangle.z] - a);
        if (glm::dot(square, square) > glm::dot(normal, normal)) normal = square, largest = triangle;
    }
    if (!(glm::length(normal) > 0.0)) return std::nullopt;
    normal = glm::normalize(normal);
    const glm::dvec3 origin = points[largest.x];
    double extent = 0.0, off = 0.0;
    for (const glm::uvec3 triangle : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 from_origin = points[triangle[k]] - origin;
            extent = std::max(extent, glm::length(from_origin));
            off = std::max(off, std::abs(glm::dot(from_origin, normal)));
        }
    }
    if (off > kFlat * extent) return std::nullopt;
    std::optional<Rectangle> smallest;
    for (int k = 0; k < 3; ++k) {
        const glm::dvec3 side = glm::normalize(points[largest[(k + 1) % 3]] - points[largest[k]]);
        const Rectangle rectangle = around(points, origin, side, normal);
        if (!smallest || rectangle.area() < smallest->area()) smallest = rectangle;
    }
    return smallest;
}

}  // namespace

std::vector<gpu::LightReceiver> find_receivers(const Scene& scene, glm::vec3 center, float reach, float texel,
                                               std::uint32_t most_texels) {
    std::vector<gpu::LightReceiver> receivers;
    std::uint32_t texels = 0;
    for (const Object& object : scene.objects) {
        if (scene.materials[std::size_t(object.material)].transmissive()) continue;
        const auto found = rectangle_of(scene.meshes[std::size_t(object.mesh)], glm::dmat4(object.world_from_object));
        if (!found) continue;
        Rectangle own = *found;
        const glm::dvec3 to_center = glm::dvec3(center) - own.origin;
        const glm::dvec2 foot(glm::dot(to_center, own.side), glm::dot(to_center, own.up));
        own.low = glm::max(own.low, foot - double(reach));
        own.high = glm::min(own.high, foot + double(reach));
        const glm::dvec2 extent = own.high - own.low;
        if (!(std::min(extent.x, extent.y) > 0.0)) continue;
        // A whole number of texels, so that they end where the rectangle does on the longer side.
        const double wanted = std::ceil(std::max(extent.x, extent.y) / double(texel) - 1e-3);
        const double edge = std::max(extent.x, extent.y) / std::clamp(wanted, 1.0, double(most_texels));
        const glm::uvec2 size(glm::max(glm::ceil(extent / edge - 1e-3), 1.0));
        const glm::dvec3 corner = own.origin + own.low.x * own.side + own.low.y * own.up;
        receivers.push_back({glm::vec4(glm::vec3(corner), float(edge)), glm::vec4(glm::vec3(own.side), float(size.x)),
                             glm::vec4(glm::vec3(own.up), float(size.y)),
                             glm::vec4(glm::vec3(own.normal), std::bit_cast<float>(texels))});
        texels += size.x * size.y;
    }
    return receivers;
}

std::uint32_t texel_count(const std::vector<gpu::LightReceiver>& receivers) {
    std::uint32_t count = 0;
    for (const gpu::LightReceiver& receiver : receivers)
        count += std::uint32_t(receiver.side.w) * std::uint32_t(receiver.up.w);
    return count;
}

}  // namespace pellucid
