#pragma once

#include <pellucid/progress.h>
#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pellucid::bake {

inline constexpr float kNoDistance = -1.0f;  ///< no surface there, or the direction leads out of it

/// A sphere around the mesh's box, in its own frame: from its centre the surface is parameterised.
struct MeshSphere {
    glm::vec3 center;
    float radius;
};
MeshSphere mesh_sphere(const Mesh& mesh);

/// Distances through the solid from `side` x `side` points of its surface in `side` x `side` directions, m in the
/// mesh's own frame: for point (px, py) and direction (dx, dy) value ((py side + px) side + dy) side + dx;
/// kNoDistance where there is none. `threads` 0: all cores.
///
/// Points and directions lie on octahedral maps: texel centres, +Z in the middle. The point is the
/// outermost one of the surface on the ray from the sphere's centre, so that a surface which
/// such a ray crosses more than once is only known by its outermost sheet.
///
/// (The geometry image of Wyman 2005, section 3.1, who leaves the parameterisation open.)
std::vector<float> sampled_distances(const Mesh& mesh, std::uint32_t side, std::uint32_t threads = 0,
                                     const Progress& progress = {});
inline std::size_t sampled_distance_count(std::uint32_t side) { return std::size_t(side) * side * side * side; }

}  // namespace pellucid::bake
