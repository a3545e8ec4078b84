#include "scene/shapes/shape_builders.h"

namespace pellucid {
namespace {

/// An axis-aligned box around the origin. Each face has `segments` x `segments` quads with its own vertices. Positions
/// on an edge are computed from the same numbers for both faces, so they are equal.
Mesh make_box(glm::dvec3 size, int segments) {
    Mesh mesh;
    const unsigned n = unsigned(segments);
    const auto coordinate = [&](unsigned i) { return double(i) / n - 0.5; };
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-0.5, 0.5}) {
            const int across = (axis + 1) % 3, along = (axis + 2) % 3;
            glm::dvec3 normal(0.0);
            normal[axis] = side;
            const unsigned first = unsigned(mesh.positions.size());
            for (unsigned i = 0; i <= n; ++i)
                for (unsigned j = 0; j <= n; ++j) {
                    glm::dvec3 position;
                    position[axis] = side;
                    position[across] = coordinate(i);
                    position[along] = coordinate(j);
                    add_vertex(mesh, position * size, normal);
                }
            for (unsigned i = 0; i < n; ++i)
                for (unsigned j = 0; j < n; ++j) {
                    const unsigned a = first + i * (n + 1) + j, b = a + n + 1, c = b + 1, d = a + 1;
                    // The cross product of across and along points to the positive side.
                    const auto add = [&](unsigned p, unsigned q, unsigned r) {
                        mesh.triangles.push_back(side > 0.0 ? glm::uvec3(p, q, r) : glm::uvec3(p, r, q));
                    };
                    add(a, b, c);
                    add(a, c, d);
                }
        }
    return mesh;
}

}  // namespace

Mesh make_cube(const ShapeArguments& arguments) {
    return make_box(glm::dvec3(arguments.number("size")), arguments.whole("segments"));
}

Mesh make_slab(const ShapeArguments& arguments) {
    return make_box({arguments.number("width"), arguments.number("height"), arguments.number("thickness")},
                    arguments.whole("segments"));
}

}  // namespace pellucid
