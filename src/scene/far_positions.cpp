#include "scene/far_positions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

/// A float has 24 bits. Beyond 8 radii its spacing exceeds a quarter of the contact tolerance, 1e-6 of the extent.
constexpr double kFarInRadii = 8.0;

double largest(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }

}  // namespace

void Box::add(const Box& box, const glm::dmat4& transform) {
    if (box.empty()) return;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 at(corner & 1, corner >> 1 & 1, corner >> 2);
        add(glm::dvec3(transform * glm::dvec4(glm::mix(box.low, box.high, at), 1.0)));
    }
}

double Box::extent() const { return empty() ? 0.0 : largest(high - low); }

Box box_of(std::span<const glm::vec3> positions) {
    Box box;
    for (const glm::vec3& p : positions) box.add(glm::dvec3(p));
    return box;
}

glm::dvec3 frame_origin(const Box& box) {
    glm::dvec3 origin(0.0);
    if (box.empty()) return origin;
    const glm::dvec3 center = 0.5 * (box.low + box.high);
    const double radius = 0.5 * glm::length(box.high - box.low);
    if (!(radius > 0.0) || !std::isfinite(radius)) return origin;
    const double step = std::exp2(std::floor(std::log2(radius)));
    for (int k = 0; k < 3; ++k)
        if (std::abs(center[k]) > kFarInRadii * radius) origin[k] = std::round(center[k] / step) * step;
    return origin;
}

glm::dvec3 recentre(Mesh& mesh) {
    const glm::dvec3 origin = frame_origin(box_of(mesh.positions));
    if (origin != glm::dvec3(0.0))
        for (glm::vec3& p : mesh.positions) p = glm::vec3(glm::dvec3(p) - origin);
    return origin;
}

void CoarsePositions::add(const std::string& mesh, const Box& box, double scale) {
    if (box.empty()) return;
    const glm::dvec3 center = 0.5 * (box.low + box.high);
    const double extent = box.extent();
    const auto farthest = static_cast<float>(largest(glm::abs(center)));
    const double spacing = double(std::nextafter(farthest, std::numeric_limits<float>::infinity())) - double(farthest);
    if (!(extent > 0.0) || !(spacing > ratio_ * extent) || !(spacing * scale > smallest_spacing_)) return;
    mesh_ = mesh;
    ratio_ = spacing / extent;
    distance_ = glm::length(center) * scale;
    spacing_ = spacing * scale;
}

void CoarsePositions::warn(Warnings& warnings) const {
    if (mesh_.empty()) return;
    warnings.add(
        fmt::format("{}: vertices are stored as 32-bit numbers {:.3g} m from their origin, where these are {:.2g} m "
                    "apart: surfaces are that coarse",
                    mesh_, distance_, spacing_));
}

}  // namespace pellucid
