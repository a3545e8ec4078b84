#pragma once

#include <pellucid/scene.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pellucid {

/// Generates a unit normal for every vertex: the mean of the surrounding triangles' normals, weighted by area, over
/// vertices of equal position. At edges bent by `crease_angle` or more (radians), each side gets its own normals and
/// vertices are split. 0 gives flat triangles, pi joins all triangles, kCreasesByShell uses each shell's
/// crease_angles(). Returns for each vertex its old index.
std::vector<std::uint32_t> make_normals(Mesh& mesh, float crease_angle);

/// Normalises all normals. Replaces zero and non-finite normals by generated ones (without creases); returns their
/// count.
std::size_t make_normals_valid(Mesh& mesh);

}  // namespace pellucid
