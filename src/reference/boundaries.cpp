#include "reference/boundaries.h"

#include <algorithm>
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

Hit touching_boundary(const Geometry& geometry, const Query& ray, const Hit& hit) {
    if (!geometry.touches_others(hit.crossing.object)) return {};
    const double apart = geometry.coincidence();
    Query nearby = ray;
    nearby.t_max = apart / std::abs(glm::dot(ray.direction, geometry.geometric_normal(hit)));
    nearby.kinds = only(SurfaceKind::kRefractive);
    const Hit other = geometry.intersect(nearby);
    if (!other.found || other.crossing.object == hit.crossing.object) return {};
    const double distance = glm::dot(other.position - hit.position, geometry.geometric_normal(other));
    return std::abs(distance) <= apart ? other : Hit{};
}

Hit cross_boundaries(const Geometry& geometry, const Query& ray, const Hit& hit, std::vector<Crossing>& standing,
                     MediumStack& inside, MediumStack& beyond) {
    beyond = inside;
    cross(geometry, hit, inside, beyond);
    if (!geometry.touches_others(hit.crossing.object)) return hit;
    std::vector<Hit> boundaries{hit};
    Query from = ray;
    for (;;) {
        from.standing = standing;
        const Hit next = touching_boundary(geometry, from, hit);
        if (!next.found) break;
        cross(geometry, next, inside, beyond);
        standing.push_back(next.crossing);
        boundaries.push_back(next);
    }
    return *std::max_element(boundaries.begin(), boundaries.end(), [&](const Hit& a, const Hit& b) {
        return rank(geometry, a, inside, beyond) < rank(geometry, b, inside, beyond);
    });
}

}  // namespace pellucid::reference
