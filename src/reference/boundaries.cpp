#include "reference/boundaries.h"

#include <cmath>
#include <cstdint>

namespace pellucid::reference {
namespace {

void cross(const Geometry& geometry, const Hit& boundary, MediumStack& inside, MediumStack& beyond) {
    const auto [object, triangle, sense] = boundary.crossing;
    if (!geometry.solids()[object].closed) inside.set(object, sense == Sense::kLeaving ? 1 : 0);
    beyond.cross(object, sense);
}

/// Of the solids whose media meet here the one of the highest precedence displaces the other.
std::int64_t rank(const Geometry& geometry, const Hit& boundary, const MediumStack& inside, const MediumStack& beyond) {
    const std::uint32_t object = boundary.crossing.object;
    const bool meets = std::int32_t(object) == inside.object() || std::int32_t(object) == beyond.object();
    return meets ? std::int64_t(geometry.solids()[object].precedence) : -1;
}

}  // namespace

Hit touching_boundary(const Geometry& geometry, Query ray, const Hit& hit) {
    if (!geometry.touches_others(hit.crossing.object)) return {};
    const double apart = geometry.coincidence();
    ray.t_max = apart / std::abs(glm::dot(ray.direction, geometry.geometric_normal(hit)));
    ray.kinds = only(SurfaceKind::kRefractive);
    const Hit other = geometry.intersect(ray);
    if (!other.found || other.crossing.object == hit.crossing.object) return {};
    const double distance = glm::dot(other.position - hit.position, geometry.geometric_normal(other));
    return std::abs(distance) <= apart ? other : Hit{};
}

Hit cross_boundaries(const Geometry& geometry, Query ray, const Hit& hit, std::vector<Crossing>& standing,
                     MediumStack& inside, MediumStack& beyond) {
    beyond = inside;
    cross(geometry, hit, inside, beyond);
    std::vector<Hit> others;
    for (;;) {
        ray.standing = standing;
        const Hit next = touching_boundary(geometry, ray, hit);
        if (!next.found) break;
        cross(geometry, next, inside, beyond);
        standing.push_back(next.crossing);
        others.push_back(next);
    }
    Hit displacing = hit;
    for (const Hit& other : others) {
        if (rank(geometry, other, inside, beyond) > rank(geometry, displacing, inside, beyond)) displacing = other;
    }
    return displacing;
}

}  // namespace pellucid::reference
