// Tubes of constant radius along closed curves. Every point lies at the radius along its normal from the curve, so the
// normals are exact. Frames by parallel transport: Bishop, "There is more than one way to frame a curve", 1975.

#include "scene/shapes/shape_builders.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pellucid {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// Rotates `v` by the rotation from unit vector `from` to unit vector `to` (not opposite).
glm::dvec3 transported(glm::dvec3 v, glm::dvec3 from, glm::dvec3 to) {
    const glm::dvec3 axis = glm::cross(from, to);
    const glm::dvec3 turned =
        v * glm::dot(from, to) + glm::cross(axis, v) + axis * (glm::dot(axis, v) / (1.0 + glm::dot(from, to)));
    return glm::normalize(turned - to * glm::dot(turned, to));
}

}  // namespace

Mesh make_tube(const std::vector<TubeRing>& rings, double radius, int sides) {
    Mesh mesh;
    const unsigned along = unsigned(rings.size()), around = unsigned(sides);
    for (const TubeRing& ring : rings)
        for (unsigned side = 0; side < around; ++side) {
            const double angle = kTwoPi * side / around;
            const glm::dvec3 normal = std::cos(angle) * ring.first_axis + std::sin(angle) * ring.second_axis;
            add_vertex(mesh, ring.center + radius * normal, normal);
        }
    // The modulo closes both seams: the last ring and side share the vertices of the first.
    const auto vertex = [&](unsigned ring, unsigned side) { return ring % along * around + side % around; };
    for (unsigned ring = 0; ring < along; ++ring)
        for (unsigned side = 0; side < around; ++side) {
            mesh.triangles.push_back({vertex(ring, side), vertex(ring, side + 1), vertex(ring + 1, side + 1)});
            mesh.triangles.push_back({vertex(ring, side), vertex(ring + 1, side + 1), vertex(ring + 1, side)});
        }
    return mesh;
}

std::vector<TubeRing> transport_rings(const std::vector<glm::dvec3>& centers,
                                      const std::vector<glm::dvec3>& unit_tangents) {
    const std::size_t count = centers.size();
    const glm::dvec3 start = unit_tangents[0];
    const glm::dvec3 aside = std::abs(start.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    std::vector<glm::dvec3> axes{glm::normalize(aside - start * glm::dot(aside, start))};
    for (std::size_t i = 1; i <= count; ++i)
        axes.push_back(transported(axes.back(), unit_tangents[i - 1], unit_tangents[i % count]));

    // Angle between the transported and the initial axis about the first tangent, after one revolution.
    const double excess = std::atan2(glm::dot(glm::cross(axes[0], axes[count]), start), glm::dot(axes[0], axes[count]));
    std::vector<TubeRing> rings;
    for (std::size_t i = 0; i < count; ++i) {
        const double twist = -excess * double(i) / double(count);
        const glm::dvec3 first = axes[i], second = glm::cross(unit_tangents[i], first);
        rings.push_back({centers[i], std::cos(twist) * first + std::sin(twist) * second,
                         std::cos(twist) * second - std::sin(twist) * first});
    }
    return rings;
}

bool tube_is_clear(const std::vector<glm::dvec3>& centers, double radius) {
    const std::size_t count = centers.size();
    std::vector<double> length_to(count + 1, 0.0);
    for (std::size_t i = 0; i < count; ++i)
        length_to[i + 1] = length_to[i] + glm::distance(centers[i], centers[(i + 1) % count]);
    const double length = length_to[count];

    for (std::size_t i = 0; i < count; ++i) {
        const glm::dvec3 a = centers[i], b = centers[(i + 1) % count], c = centers[(i + 2) % count];
        const double bend = glm::length(glm::cross(b - a, c - b));
        const double circumradius = 0.5 * glm::length(b - a) * glm::length(c - b) * glm::length(c - a);
        if (circumradius <= radius * bend) return false;
        // If the curvature radius is nowhere below the tube's radius, the curve can approach itself to a diameter only
        // after more than half a circle (Schur's theorem).
        for (std::size_t j = i + 1; j < count; ++j) {
            const double apart = length_to[j] - length_to[i];
            if (std::min(apart, length - apart) > std::numbers::pi * radius &&
                glm::distance(centers[i], centers[j]) <= 2.0 * radius)
                return false;
        }
    }
    return true;
}

Mesh make_torus(const ShapeArguments& arguments) {
    const int segments = arguments.whole("segments");
    const double radius = arguments.number("radius"), tube = arguments.number("tube");
    if (tube >= radius) arguments.fail("tube must be less than radius");
    std::vector<TubeRing> rings;
    for (int i = 0; i < segments; ++i) {
        const double angle = kTwoPi * i / segments;
        const glm::dvec3 outward(std::cos(angle), std::sin(angle), 0.0);
        rings.push_back({radius * outward, outward, {0.0, 0.0, -1.0}});
    }
    return make_tube(rings, tube, arguments.whole("sides"));
}

}  // namespace pellucid
