#pragma once

#include "core/math.h"
#include "scene/shapes/shape_arguments.h"

#include <vector>

namespace pellucid {

// One function per shape; the table of names and parameters is in shapes.cpp.
Mesh make_sphere(const ShapeArguments& arguments);
Mesh make_hollow_sphere(const ShapeArguments& arguments);
Mesh make_cube(const ShapeArguments& arguments);
Mesh make_slab(const ShapeArguments& arguments);
Mesh make_torus(const ShapeArguments& arguments);
Mesh make_infinity_ring(const ShapeArguments& arguments);
Mesh make_knot(const ShapeArguments& arguments);
Mesh make_goblet(const ShapeArguments& arguments);
Mesh make_bottle(const ShapeArguments& arguments);
Mesh make_gem(const ShapeArguments& arguments);

// What several shapes are made from. Computed in double, rounded once at the end.

/// Appends a vertex and returns its index. Never stores -0, so that equal positions are also equal
/// bit by bit.
unsigned add_vertex(Mesh& mesh, glm::dvec3 position, glm::dvec3 normal);

/// Appends a flat convex polygon, corners counter-clockwise seen from outside, with vertices of its
/// own.
void add_facet(Mesh& mesh, const std::vector<glm::dvec3>& corners);

/// A circle of a tube: its centre and the two unit axes of its plane, first x second along the tube.
struct TubeRing {
    glm::dvec3 center;
    glm::dvec3 first_axis;
    glm::dvec3 second_axis;
};

/// A tube through `rings` and back from the last to the first, `sides` quads around each.
Mesh make_tube(const std::vector<TubeRing>& rings, double radius, int sides);

/// Rings along a closed curve without twist: parallel transport, and what is then missing at the
/// joint is spread evenly over the length.
std::vector<TubeRing> transport_rings(const std::vector<glm::dvec3>& centers,
                                      const std::vector<glm::dvec3>& unit_tangents);

/// Whether a tube of `radius` around the closed curve keeps clear of itself: it neither bends
/// tighter than its radius nor touches another stretch of itself.
bool tube_is_clear(const std::vector<glm::dvec3>& centers, double radius);

/// A point of the half plane that is turned around the Y axis.
struct ProfilePoint {
    glm::dvec2 position;  ///< distance from the axis, height
    glm::dvec2 normal;    ///< unit, out of the solid
};

/// Solid of revolution around +Y. The profile has the solid on its left and begins and ends on the
/// axis, where it makes a fan around one vertex.
Mesh revolve(const std::vector<ProfilePoint>& profile, int segments);

/// A profile for revolve(): the uniform cubic B-spline of control points (distance from the axis, height), which begin
/// and end on the axis and are met there at right angles. It has `rings` stretches, shorter where it bends.
std::vector<ProfilePoint> spline_profile(const std::vector<glm::dvec2>& control_points, int rings);

/// Appends the inside of a vessel to control points: those of its `outside` but the first, which go up and on to `end`,
/// backwards and moved by `wall` to the side on which the axis is.
void add_inside(std::vector<glm::dvec2>& points, const std::vector<glm::dvec2>& outside, glm::dvec2 end, double wall);

}  // namespace pellucid
