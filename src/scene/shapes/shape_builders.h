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
Mesh make_vase(const ShapeArguments& arguments);
Mesh make_gem(const ShapeArguments& arguments);

// Building blocks of several shapes, computed in double and rounded once at the end.

/// Appends a vertex and returns its index. Never stores -0, so that equal positions are equal bit by bit.
unsigned add_vertex(Mesh& mesh, glm::dvec3 position, glm::dvec3 normal);

/// Appends a flat convex polygon with its own vertices. Corners are counter-clockwise seen from outside.
void add_facet(Mesh& mesh, const std::vector<glm::dvec3>& corners);

/// A circle of a tube: its centre and the two unit axes of its plane; first x second points along the tube.
struct TubeRing {
    glm::dvec3 center;
    glm::dvec3 first_axis;
    glm::dvec3 second_axis;
};

/// A closed tube through `rings`, with `sides` quads around each.
Mesh make_tube(const std::vector<TubeRing>& rings, double radius, int sides);

/// Rings along a closed curve by parallel transport. The remaining angle at the joint is distributed evenly over the
/// length.
std::vector<TubeRing> transport_rings(const std::vector<glm::dvec3>& centers,
                                      const std::vector<glm::dvec3>& unit_tangents);

/// True if a tube of `radius` around the closed curve does not intersect itself: no bend is tighter than the radius,
/// and no two segments touch.
bool tube_is_clear(const std::vector<glm::dvec3>& centers, double radius);

/// A point of the half plane that is revolved around the Y axis.
struct ProfilePoint {
    glm::dvec2 position;  ///< distance from the axis, height
    glm::dvec2 normal;    ///< unit, outward
};

/// Solid of revolution around +Y. The solid lies on the profile's left. The profile begins and ends on the axis, where
/// it forms a fan around one vertex. `half`: half a turn behind the plane z = 0, open there.
Mesh revolve(const std::vector<ProfilePoint>& profile, int segments, bool half = false);

/// A profile for revolve(): the uniform cubic B-spline of control points (distance from the axis, height). It begins
/// and ends on the axis at right angles. It has `rings` segments, shorter at bends.
std::vector<ProfilePoint> spline_profile(const std::vector<glm::dvec2>& control_points, int rings);

/// Appends the inside of a vessel to control points: the points of `outside` except the first, in reverse order,
/// offset by `wall` towards the axis. `outside` continues to `end`.
void add_inside(std::vector<glm::dvec2>& points, const std::vector<glm::dvec2>& outside, glm::dvec2 end, double wall);

}  // namespace pellucid
