#pragma once

#include <pellucid/api.h>
#include <pellucid/scene.h>

#include <cstdint>
#include <string>
#include <vector>

namespace pellucid {

/// Crease angle, radians, of normals that are smooth across every edge.
inline constexpr float kSmooth = 3.14159265f;

/// Generates a unit normal for every vertex: the mean of the surrounding triangles' normals, weighted by area, over
/// vertices of equal position. At edges bent by `crease_angle` or more (radians), each side gets its own normals and
/// vertices are split. 0 gives flat triangles, kSmooth joins all triangles and splits none, kCreasesByShell lets each
/// shell choose its angle. Returns for each vertex its old index. Triangles must refer to
/// vertices that are there.
PELLUCID_API std::vector<std::uint32_t> make_normals(Mesh& mesh, float crease_angle);

/// Throws Error naming `what` if an attribute has another count than the positions or is not finite, or a triangle
/// refers to a missing vertex.
PELLUCID_API void check_mesh(const Mesh& mesh, const std::string& what);

}  // namespace pellucid
