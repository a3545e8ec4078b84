#pragma once

#include "gpu/workspace.h"

#include <pellucid/scene.h>

#include <cstdint>
#include <vector>

namespace pellucid {

/// The share of every voxel of `grid` (its size, low and voxel) that lies in a solid, 0..1. Shells that overlap count as
/// one solid, and one that is turned inside out cuts a hole. `samples` columns along x and y of a voxel, 1..16. Triangles
/// must lie inside the grid. Where a column does not leave the solid as often as it enters it, what is left open counts
/// as outside.
std::vector<float> mesh_coverage(Workspace& workspace, const Volume& grid, const Mesh& mesh,
                                 const glm::mat4& grid_from_mesh, std::uint32_t samples);

}  // namespace pellucid
