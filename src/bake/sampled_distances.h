#pragma once

#include <pellucid/progress.h>
#include <pellucid/scene.h>

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pellucid::bake {

inline constexpr float kNoDistance = -1.0f;  ///< no surface there, or the direction leads out of the solid

/// A sphere around the mesh, in its own frame. The surface is parameterised by directions from the sphere's centre,
/// which is that of the mesh's box.
struct MeshSphere {
    glm::vec3 center;
    float radius;
};
MeshSphere mesh_sphere(const Mesh& mesh);

/// Distances through the solid, m in the mesh's own frame, from `side` x `side` points in `side` x `side` directions.
/// Point (px, py) and direction (dx, dy) have value number ((py side + px) side + dy) side + dx. The value is
/// kNoDistance if there is no distance. `threads`: 0 for all cores.
///
/// Points and directions are texel centres of octahedral maps, with +Z at the centre. A point is the outermost point of
/// the surface on a ray from the sphere's centre. If a ray crosses the surface more than once, only the outermost sheet
/// is sampled.
///
/// (The geometry image of Wyman 2005, section 3.1, who leaves the parameterisation open.)
std::vector<float> sampled_distances(const Mesh& mesh, std::uint32_t side, std::uint32_t threads = 0,
                                     const Progress& progress = {});
inline std::size_t sampled_distance_count(std::uint32_t side) { return std::size_t(side) * side * side * side; }

}  // namespace pellucid::bake
