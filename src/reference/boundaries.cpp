#include "reference/boundaries.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace pellucid::reference {
namespace {

void cross(const Geometry& geometry, const Hit& boundary, MediumStack& inside, MediumStack& beyond) {
    const std::uint32_t solid = geometry.solid_of(boundary.crossing.shell);
    const Sense sense = boundary.crossing.sense;
    if (!geometry.solids()[solid].closed) inside.set(solid, sense == Sense::kLeaving ? 1 : 0);
    beyond.cross(solid, sense);
}

/// Rank of the solid at a boundary: its precedence if its medium meets another there, else -1. The solid of the
/// highest rank displaces the others.
std::int64_t rank(const Geometry& geometry, const Hit& boundary, const MediumStack& inside, const MediumStack& beyond) {
    const std::uint32_t solid = geometry.solid_of(boundary.crossing.shell);
    const bool meets = std::int32_t(solid) == inside.solid() || std::int32_t(solid) == beyond.solid();
    return meets ? std::int64_t(geometry.solids()[solid].precedence) : -1;
}

}  // namespace

Hit touching_boundary(const Geometry& geometry, const Query& ray, const Hit& hit) {
    if (!geometry.touches_others(hit.crossing.shell)) return {};
    Query nearby = ray;
    nearby.t_max = geometry.widest_contact() / std::abs(glm::dot(ray.direction, geometry.geometric_normal(hit)));
    nearby.kinds = only(SurfaceKind::kRefractive);
    const Hit other = geometry.intersect(nearby);
    if (!other.found || other.crossing.shell == hit.crossing.shell) return {};
    const double distance = glm::dot(other.position - hit.position, geometry.geometric_normal(other));
    return std::abs(distance) <= geometry.contact(hit.crossing.shell, other.crossing.shell, hit.position) ? other
                                                                                                          : Hit{};
}

Hit cross_boundaries(const Geometry& geometry, const Query& ray, const Hit& hit, std::vector<Crossing>& standing,
                     MediumStack& inside, MediumStack& beyond) {
    beyond = inside;
    cross(geometry, hit, inside, beyond);
    if (!geometry.touches_others(hit.crossing.shell)) return hit;
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
