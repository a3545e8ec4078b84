#pragma once

#include <pellucid/scene.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pellucid {

/// Makes a unit normal for every vertex: the mean of the surrounding triangles' normals, weighted
/// by area, over vertices of equal position. Where two triangles meet at an edge bent by
/// `crease_angle` or more (radians), each side gets its own normals and vertices are split;
/// 0 makes flat triangles, pi joins everything, kCreasesByShell takes each shell's crease_angles(). Returns for each vertex the one that it was before.
std::vector<std::uint32_t> make_normals(Mesh& mesh, float crease_angle);

/// Scales normals to unit length. Those that are zero or not finite are replaced by made ones
/// (without creases); returns how many.
std::size_t make_normals_valid(Mesh& mesh);

}  // namespace pellucid
