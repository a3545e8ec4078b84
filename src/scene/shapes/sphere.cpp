#include "scene/shapes/shape_builders.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace pellucid {
namespace {

/// A sphere of rows of vertices: row 0 is the pole, and row k of a hemisphere has 4k vertices. Spacing along and
/// across rows stays within a factor pi/2, unlike on a UV sphere.
class OctahedralSphere {
public:
    explicit OctahedralSphere(int segments) : segments_(unsigned(segments)) {}

    void append_to(Mesh& mesh, double radius, bool inward) const {
        const unsigned base = unsigned(mesh.positions.size());
        for (unsigned row = 0; row <= 2 * segments_; ++row)
            for (unsigned i = 0; i < row_length(row); ++i) {
                const glm::dvec3 direction = point(row, i);
                add_vertex(mesh, radius * direction, inward ? -direction : direction);
            }
        for (unsigned row = 0; row < segments_; ++row) {
            append_strip(mesh, base, row, row + 1, inward);                                   // northern hemisphere
            append_strip(mesh, base, 2 * segments_ - row, 2 * segments_ - row - 1, !inward);  // southern hemisphere
        }
    }

private:
    unsigned steps_from_pole(unsigned row) const { return std::min(row, 2 * segments_ - row); }
    unsigned row_length(unsigned row) const { return std::max(4 * steps_from_pole(row), 1u); }

    /// Index of the first vertex of a row, counted from the north pole.
    unsigned row_start(unsigned row) const {
        const unsigned n = segments_;
        if (row == 0) return 0;
        if (row <= n) return 1 + 2 * row * (row - 1);
        const unsigned left = 2 * n - row;  // rows after this one, all of them shorter
        return vertex_count() - row_length(row) - (left == 0 ? 0 : 1 + 2 * left * (left - 1));
    }
    unsigned vertex_count() const { return 4 * segments_ * segments_ + 2; }

    glm::dvec3 point(unsigned row, unsigned i) const {
        if (row == 0) return {0.0, 1.0, 0.0};
        if (row == 2 * segments_) return {0.0, -1.0, 0.0};
        const double colatitude = 0.5 * std::numbers::pi * row / segments_;
        const double longitude = 2.0 * std::numbers::pi * i / row_length(row);
        return {std::sin(colatitude) * std::cos(longitude), std::cos(colatitude),
                std::sin(colatitude) * std::sin(longitude)};
    }

    /// Appends the triangles between a row and the next longer row, in each of the four octants.
    void append_strip(Mesh& mesh, unsigned base, unsigned inner_row, unsigned outer_row, bool flip) const {
        const unsigned steps = steps_from_pole(inner_row);
        const auto vertex = [&](unsigned row, unsigned i) { return base + row_start(row) + i % row_length(row); };
        const auto add = [&](unsigned a, unsigned b, unsigned c) {
            mesh.triangles.push_back(flip ? glm::uvec3(a, b, c) : glm::uvec3(a, c, b));
        };
        for (unsigned octant = 0; octant < 4; ++octant) {
            const unsigned inner = octant * steps, outer = octant * (steps + 1);
            for (unsigned i = 0; i <= steps; ++i) {
                add(vertex(inner_row, inner + i), vertex(outer_row, outer + i), vertex(outer_row, outer + i + 1));
                if (i < steps)
                    add(vertex(inner_row, inner + i), vertex(outer_row, outer + i + 1),
                        vertex(inner_row, inner + i + 1));
            }
        }
    }

    unsigned segments_;
};

}  // namespace

Mesh make_sphere(const ShapeArguments& arguments) {
    Mesh mesh;
    OctahedralSphere(arguments.whole("segments")).append_to(mesh, arguments.number("radius"), false);
    return mesh;
}

Mesh make_hollow_sphere(const ShapeArguments& arguments) {
    Mesh mesh;
    const OctahedralSphere sphere(arguments.whole("segments"));
    const double radius = arguments.number("radius");
    sphere.append_to(mesh, radius, false);
    sphere.append_to(mesh, radius * arguments.number("inner"), true);
    return mesh;
}

}  // namespace pellucid
