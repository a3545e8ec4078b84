#include "scene/shapes/shape_builders.h"

#include <cmath>
#include <numbers>

namespace pellucid {
namespace {

glm::vec3 rounded(glm::dvec3 v) {
    return glm::vec3(v) + 0.0f;  // -0 + 0 is 0
}

/// Unit (x, z) after `i` of `count` equal parts of a whole turn.
glm::dvec2 turn(unsigned i, unsigned count) {
    const double longitude = 2.0 * std::numbers::pi * i / count;
    return {std::cos(longitude), std::sin(longitude)};
}

/// The same of half a turn behind the plane z = 0, which both ends meet exactly.
glm::dvec2 half_turn(unsigned i, unsigned count) {
    if (i == 0) return {-1.0, 0.0};
    if (i == count) return {1.0, 0.0};
    const double longitude = std::numbers::pi * (1.0 + double(i) / count);
    return {std::cos(longitude), std::sin(longitude)};
}

}  // namespace

unsigned add_vertex(Mesh& mesh, glm::dvec3 position, glm::dvec3 normal) {
    mesh.positions.push_back(rounded(position));
    mesh.normals.push_back(rounded(glm::normalize(normal)));
    return unsigned(mesh.positions.size() - 1);
}

void add_facet(Mesh& mesh, const std::vector<glm::dvec3>& corners) {
    const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const unsigned first = add_vertex(mesh, corners[0], normal);
    for (std::size_t i = 1; i < corners.size(); ++i) {
        const unsigned last = add_vertex(mesh, corners[i], normal);
        if (i >= 2) mesh.triangles.push_back({first, last - 1, last});
    }
}

Mesh revolve(const std::vector<ProfilePoint>& profile, int segments, bool half) {
    Mesh mesh;
    const unsigned around = unsigned(segments);
    const unsigned ring_count = unsigned(profile.size()) - 2;
    const unsigned columns = half ? around + 1 : around;
    const auto pole = [&](const ProfilePoint& point) {
        return add_vertex(mesh, {0.0, point.position.y, 0.0}, {0.0, point.normal.y, 0.0});
    };

    const unsigned start = pole(profile.front());
    const unsigned first = start + 1;
    for (unsigned ring = 0; ring < ring_count; ++ring) {
        const ProfilePoint& point = profile[ring + 1];
        for (unsigned i = 0; i < columns; ++i) {
            const glm::dvec2 way = half ? half_turn(i, around) : turn(i, around);
            add_vertex(mesh, {point.position.x * way.x, point.position.y, point.position.x * way.y},
                       {point.normal.x * way.x, point.normal.y, point.normal.x * way.y});
        }
    }
    const unsigned end = pole(profile.back());

    // The modulo closes the seam of a whole turn: the last column shares the vertices of the first.
    const auto vertex = [&](unsigned ring, unsigned i) { return first + ring * columns + i % columns; };
    for (unsigned i = 0; i < around; ++i) {
        mesh.triangles.push_back({start, vertex(0, i), vertex(0, i + 1)});
        for (unsigned ring = 0; ring + 1 < ring_count; ++ring) {
            mesh.triangles.push_back({vertex(ring, i), vertex(ring + 1, i), vertex(ring + 1, i + 1)});
            mesh.triangles.push_back({vertex(ring, i), vertex(ring + 1, i + 1), vertex(ring, i + 1)});
        }
        mesh.triangles.push_back({end, vertex(ring_count - 1, i + 1), vertex(ring_count - 1, i)});
    }
    return mesh;
}

}  // namespace pellucid
